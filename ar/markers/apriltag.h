#pragma once
// The search of AprilTag 3 (Krogius et al. 2019) by its makers' library, which finds small and slanted tags that
// the search for ArUco's squares misses (docs/results).

#include "ar/markers/aruco.h"

namespace ar {

bool is_apriltag(std::string const& dictionary);

/// Upright as the makers' pictures; corners are the library's own. `rejected` counts codes whose bits
/// had too little contrast.
/// @param gray CV_8UC1 @param dictionary of which is_apriltag
/// @param step  the search for squares looks at every so many pixels a side: 1 or 2
FoundMarkers find_apriltags(cv::Mat const& gray, std::string const& dictionary, int step);

} // namespace ar
