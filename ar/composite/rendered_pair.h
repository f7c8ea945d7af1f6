#pragma once
// What the renderer hands over: the same view twice, with and without the virtual objects, both made with the same
// random numbers, so that what the objects do not change is equal bit for bit and its noise cancels.

#include <opencv2/core.hpp>

namespace ar {

/// All of one size, rows from the top.
struct RenderedPair {
    cv::Mat with;    ///< CV_32FC3 RGB, radiance: proxies of the real place and virtual objects
    cv::Mat without; ///< CV_32FC3 RGB, radiance: proxies alone
    /// CV_32FC1, 0..1: part of the pixel that shows virtual objects themselves, nearer than proxies
    cv::Mat coverage;
    /// CV_32FC3 RGB, radiance of virtual objects themselves times coverage; may be empty. Where coverage is
    /// between 0 and 1 it tells the object's light from the place's, which ratios and clipped bytes need.
    cv::Mat direct = {};
};

/// @throws gi::InputError where types or sizes are not those above, or (size not empty) not that of the camera's
/// frame
void check(RenderedPair const& pair, cv::Size size = {});

} // namespace ar
