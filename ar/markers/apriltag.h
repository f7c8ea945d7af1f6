#pragma once
// Detection with the original AprilTag 3 library (Krogius et al. 2019), which finds small and slanted tags that
// OpenCV's ArUco search misses (docs/decisions/markers.md).

#include "ar/markers/aruco.h"

namespace ar {

bool is_apriltag(std::string const& dictionary);

/// Finds AprilTags. Corners start at the tag's upper left, upright as in the pictures that its makers publish;
/// their positions are those of the AprilTag library, not refined further. `rejected` counts codes whose bits had
/// too little contrast.
/// @param gray CV_8UC1 @param dictionary must satisfy is_apriltag
/// @param step  the search for squares uses every step-th pixel in each direction: 1 or 2
FoundMarkers find_apriltags(cv::Mat const& gray, std::string const& dictionary, int step);

} // namespace ar
