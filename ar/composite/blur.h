#pragma once
// What the camera's lens and shutter do to sharp borders, done to what is rendered. Of a pair, what is added and
// the coverage are blurred (out = added + (1 - a) camera, see temporal.h): the camera's picture is blurred
// already. The point spread acts on light, so all is linear. Where nothing virtual is within reach the result is
// nothing, exactly.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/composite/rendered_pair.h"

namespace ar {

/// Sigma of the Gaussian that takes a picture from one sharpness to another; 0 where the camera's is sharper.
/// @param camera_px    as estimate_sharpness finds it
/// @param rendered_px  of the rendered picture: 0.289 (= 1 / sqrt(12)) for the mean over a pixel
double missing_blur_px(double camera_px, double rendered_px = 0.289);

/// Defocus. @param sigma_px  0 gives the pair itself; beyond 0..20 is @throws gi::InputError
RenderedPair defocused(RenderedPair const& pair, double sigma_px);

/// Motion while the shutter is open: the mean along each pixel's path (rows of Potmesil and Chakravarty 1983),
/// with what moves past a pixel spread beyond its own border (largest velocity of the neighbourhood, McGuire et
/// al. 2012).
/// @param velocity_px  CV_32FC2: path of what the pixel shows while the shutter is open, pixels; not finite counts
/// as 0
/// @param longest_px   longer paths are cut to this
RenderedPair motion_blurred(RenderedPair const& pair, cv::Mat const& velocity_px, double longest_px = 48);

/// CV_32FC2: how far what is shown at each pixel moves in the picture between two poses (from `before` to `after`,
/// seen at `after`), for things that stand still. @param depth  CV_32FC1, metres along the axis, 0 = infinitely
/// far
/// @param pinhole  of the size of depth; @throws gi::InputError another lens or size
cv::Mat image_velocity(CameraModel const& pinhole, cv::Mat const& depth, Pose const& world_from_camera_before,
                       Pose const& world_from_camera_after);

} // namespace ar
