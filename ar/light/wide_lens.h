#pragma once
// Environments from pictures of fisheye lenses (or any lens): radiance from an exposure bracket, the lens and
// where it looks. Two that look opposite ways are merged by ar::merged.

#include "ar/base/camera_model.h"
#include "ar/light/lat_long.h"

namespace ar {

struct WideLensSettings {
    cv::Size size{512, 256};
    double largest_angle_rad =
        3.14159265358979;   ///< to the axis: beyond it the picture is dark, or not to be trusted
    double fade_rad = 0.09; ///< over which the weight falls to 0 before it, so that merged pictures have no seam
};

/// @param radiance CV_32FC3, of the camera's size
/// @throws InputError as check_picture, or sizes and angles that are not positive
PartialMap unwrap_lens(cv::Mat const& radiance, CameraModel const& camera, glm::dquat const& world_from_camera,
                       WideLensSettings const& settings = {});

} // namespace ar
