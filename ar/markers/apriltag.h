#pragma once
// Detection with the original AprilTag 3 library (Krogius et al. 2019), which finds small and slanted tags that
// OpenCV's ArUco search misses (docs/results).

#include "ar/markers/aruco.h"

namespace ar {

bool is_apriltag(std::string const& dictionary);

/// Corner order is upright as in the makers' pictures; corner positions are the library's own. `rejected` counts
/// codes whose bits had too little contrast.
/// @param gray CV_8UC1 @param dictionary must satisfy is_apriltag
/// @param step  the search for squares uses every step-th pixel in each direction: 1 or 2
FoundMarkers find_apriltags(cv::Mat const& gray, std::string const& dictionary, int step);

} // namespace ar
