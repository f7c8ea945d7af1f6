#pragma once
// Blurs rendered pictures as the camera's lens and shutter do. Only the added light and the coverage of a pair are
// blurred (out = added + (1 - a) camera, see temporal.h): the camera's picture is blurred already. The point
// spread function acts on light, so all computation is linear. The added light is exactly 0 beyond the blur's
// reach of virtual objects.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/composite/rendered_pair.h"

namespace ar {

/// Sigma of the Gaussian that blurs the rendered picture to the camera's sharpness; 0 if the camera is sharper.
/// @param camera_px    sigma from estimate_sharpness
/// @param rendered_px  sigma of the rendered picture: 0.289 (= 1 / sqrt(12)) for the mean over a pixel
double missing_blur_px(double camera_px, double rendered_px = 0.289);

/// Applies defocus blur. @param sigma_px  0 returns the pair unchanged. @throws gi::InputError outside 0..20
RenderedPair defocused(RenderedPair const& pair, double sigma_px);

/// Applies motion blur: the mean along each pixel's motion while the shutter is open (Potmesil
/// and Chakravarty 1983); moving objects also spread beyond their own border (largest velocity in
/// the neighbourhood, McGuire et al. 2012).
/// @param velocity_px  CV_32FC2: motion of the pixel's content while the shutter is open, pixels;
/// non-finite values count as 0
/// @param longest_px   longer motions are shortened to this
RenderedPair motion_blurred(RenderedPair const& pair, cv::Mat const& velocity_px, double longest_px = 48);

/// Motion of static surfaces in the picture between two camera poses (from `before` to `after`), at their pixels
/// in `after`: CV_32FC2. @param depth  CV_32FC1, metres along the axis, 0 = infinitely far
/// @param pinhole  must have the size of depth; @throws gi::InputError another lens or size
cv::Mat image_velocity(CameraModel const& pinhole, cv::Mat const& depth,
                       gi::RigidPose const& world_from_camera_before,
                       gi::RigidPose const& world_from_camera_after);

} // namespace ar
