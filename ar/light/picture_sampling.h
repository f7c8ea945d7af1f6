#pragma once
// Resamples a picture to directions; shared by mirror balls and lenses.

#include "ar/camera/camera_model.h"
#include "ar/light/lat_long.h"

#include <functional>
#include <string>

namespace ar {

/// Pixel at which a world direction is seen; weight 0 = not visible.
struct PictureSample {
    glm::dvec2 pixel{0};
    double weight = 0;
};

/// Each texel is the mean of the bilinearly sampled picture over a grid of directions in the texel with weight >
/// 0, by solid angle; its weight is their mean weight. Directions outside the picture are not seen.
PartialMap gather(cv::Mat const& radiance, cv::Size size, double pixels_per_texel,
                  std::function<PictureSample(glm::dvec3)> const& look);

/// @throws gi::InputError not CV_32FC3 of the camera's size, or not finite, or negative
void check_picture(cv::Mat const& radiance, CameraModel const& camera, std::string const& where);

} // namespace ar
