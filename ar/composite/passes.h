#pragma once
// The parts of a composite as separate pictures of linear light, for a compositing program. They add up exactly
// (to rounding of floats), whatever the settings of the compositor:
//   composite = objects.rgb + (1 - alpha) background + added + noise

#include "ar/composite/composite.h"

namespace ar {

/// Radiance (linear BT.709), CV_32FC3, unless stated; all of the frame's size and lens.
struct CompositePasses {
    cv::Mat composite;  ///< of the picture that was written
    cv::Mat background; ///< the camera's frame, with the camera's own noise
    cv::Mat objects;    ///< CV_32FC4: light of directly visible virtual objects and alpha, premultiplied
    cv::Mat added;      ///< signed: change of the place, shadows negative; the sum above defines it
    cv::Mat noise;      ///< signed: the noise that the compositor adds, and rounding to the camera's codes
    cv::Mat shadow;     ///< ratio 0..1: the model of the place with / without virtual objects, where it darkens
    cv::Mat indirect;   ///< >= 0: light that the model of the place gains, times 1 - alpha
};

/// @param compositor  as the composite was made with
/// @param camera      the frame (picture_of)   @param written  its composite, of the same type
/// Pixels whose pair is not finite, where the compositor leaves the camera's, are as without virtual objects.
/// @throws gi::InputError wrong types or sizes
CompositePasses passes_of(Compositor& compositor, cv::Mat const& camera, cv::Mat const& written,
                          RenderedPair const& pair, Exposure const& exposure);
/// Passes of a frame without virtual objects, for example one without a camera pose.
CompositePasses passes_of_nothing(Photometry const& photometry, cv::Mat const& camera, Exposure const& exposure);

} // namespace ar
