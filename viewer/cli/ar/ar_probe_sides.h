#pragma once
// Pictures of a mirror ball beside markers, side by side of it: their light, and where the camera was.

#include "ar/calibration/calibration_file.h"
#include "ar/camera/pose.h"
#include "ar/markers/marker_map.h"

#include <string>
#include <vector>

namespace viewer {

/// Pictures from one place, one for each exposure.
struct ProbeSide {
    std::string name; ///< of the first picture
    cv::Mat radiance; ///< CV_32FC3
    ar::Pose world_from_camera;
};

/// @param pictures all of one side, then all of the next
/// @param seconds exposures of the pictures of each side; empty: each picture is a side
/// @throws InputError pictures and exposures that do not go together, another size, no camera found by the markers
std::vector<ProbeSide> read_probe_sides(std::vector<std::string> const& pictures,
                                        std::vector<double> const& seconds, ar::Calibration const& calibration,
                                        ar::MarkerMap const& map);

} // namespace viewer
