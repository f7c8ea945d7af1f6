#pragma once
// The renderer's output: the same view with and without the virtual objects, rendered with the same random
// numbers, so that pixels that the objects do not change are equal bit for bit and their noise cancels.

#include <opencv2/core.hpp>

namespace ar {

/// True if all components are finite (0 times a non-finite value is NaN).
inline bool is_finite(cv::Vec3f const& v)
{
    float const zero = 0 * v[0] + 0 * v[1] + 0 * v[2];
    return zero == 0;
}

/// All pictures have the same size, rows from the top.
struct RenderedPair {
    cv::Mat with;    ///< CV_32FC3 RGB, radiance: proxies of the real place and virtual objects
    cv::Mat without; ///< CV_32FC3 RGB, radiance: proxies alone
    /// CV_32FC1, 0..1: share of the pixel where virtual objects are directly visible, in front of proxies
    cv::Mat coverage;
    /// CV_32FC3 RGB, radiance of directly visible virtual objects times coverage; may be empty. Where coverage is
    /// between 0 and 1 it separates the object's light from the place's, as ratios and clipped bytes need.
    cv::Mat direct = {};
};

/// @throws gi::InputError if types or sizes are not those above, or `size` is not empty and differs
void check(RenderedPair const& pair, cv::Size size = {});

/// The pair with `share` (0 to 1) of the change by virtual objects: light, shadows and coverage alike. Where the
/// pair does not differ, the result does not either.
RenderedPair faded(RenderedPair const& pair, double share);

} // namespace ar
