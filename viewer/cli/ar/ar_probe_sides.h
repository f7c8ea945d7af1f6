#pragma once
// Pictures of a mirror ball beside markers, taken from several sides: radiance and camera pose of each side.

#include "ar/calibration/calibration_file.h"
#include "ar/camera/pose.h"
#include "ar/markers/marker_map.h"

#include <string>
#include <vector>

namespace viewer {

/// The pictures from one place, merged over their exposures.
struct ProbeSide {
    std::string name; ///< file name of the first picture
    cv::Mat radiance; ///< CV_32FC3
    gi::RigidPose world_from_camera;
    cv::Mat clipped{}; ///< CV_8UC1: 255 where a channel is white in the shortest exposure
};

/// @param pictures all pictures of one side, then all of the next
/// @param seconds exposure times of the pictures of each side; empty: each picture is a side of its own
/// @throws InputError if numbers of pictures and exposures do not match, on a wrong size, or without a camera pose
std::vector<ProbeSide> read_probe_sides(std::vector<std::string> const& pictures,
                                        std::vector<double> const& seconds, ar::Calibration const& calibration,
                                        ar::MarkerMap const& map);

} // namespace viewer
