#pragma once
// From a picture to the directions it shows: what mirror balls and lenses share.

#include "ar/camera/camera_model.h"
#include "ar/light/lat_long.h"

#include <functional>
#include <string>

namespace ar {

/// Where in the picture a direction of the world is seen, and how well (0 = not).
struct PictureSample {
    glm::dvec2 pixel{0};
    double weight = 0;
};

/// Each texel: the mean of the picture, bilinear, at a grid of directions in it, by solid angle, where weight > 0;
/// its weight is the mean of theirs. What falls outside the picture is not seen.
PartialMap gather(cv::Mat const& radiance, cv::Size size, double pixels_per_texel,
                  std::function<PictureSample(glm::dvec3)> const& look);

/// @throws gi::InputError not CV_32FC3 of the camera's size, or not finite, or negative
void check_picture(cv::Mat const& radiance, CameraModel const& camera, std::string const& where);

} // namespace ar
