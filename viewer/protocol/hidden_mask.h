#pragma once
// Hidden areas of a view, such as the parts of an eye's picture that the lens never shows
// (XR_KHR_visibility_mask). They are not rendered. A mask is set by a Change with the key "hidden.VIEW"
// and the value
//   {"points": [[x, y], ...], "triangles": [i, j, k, ...]}
// where points are tangents as below; without triangles, nothing of that view is hidden.

#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Triangles that cover the hidden area, in the plane one metre in front of the eye:
/// x to the right, y up, as tangents.
struct HiddenMask {
    std::vector<gi::vec2> points;         ///< finite
    std::vector<std::uint32_t> triangles; ///< three indices each

    bool operator==(HiddenMask const&) const = default;
};

/// Limits of a mask, so that its text stays within CommandLimits::value_bytes.
struct HiddenMaskLimits {
    static constexpr std::size_t points = 8192, triangles = 16384;
    static constexpr double tangent = 1e4;
};

/// Width of the rendered guard band inside the hidden area, as a tangent. It is needed because reprojection to the
/// current head pose (viewer/devices/gl/reprojection.h) brings pixels from beyond the visible border into view.
/// The value: a head that turns by 30 degrees per second, over the 50 ms between two pictures, moves points 45
/// degrees off the axis by 1.5 degrees / cos^2(45 degrees) = 0.052.
inline constexpr double kHiddenGuard = 0.052;
/// Minimum width of the guard band in pixels, for the windows of temporal reuse and the filter.
inline constexpr int kHiddenGuard_px = 4;

/// 1 for each pixel whose centre is hidden, rows from the top. Triangles with an invalid index are ignored.
/// @param view  extent of the picture
std::vector<std::uint8_t> hidden_pixels(HiddenMask const& mask, gi::ViewTangents const& view, int width,
                                        int height);
/// 1 for each pixel that need not be rendered: hidden, and farther than the guard band from every visible pixel.
/// Nothing beyond the picture counts as visible.
std::vector<std::uint8_t> pixels_to_leave_out(HiddenMask const& mask, gi::ViewTangents const& view, int width,
                                              int height);

/// True if a key names the mask of a view.
bool is_hidden_mask(std::string const& key);
Change hidden_change(std::string const& view, HiddenMask const& mask);
/// View and mask of a hidden-mask change. Throws InputError if the value is malformed, numbers are not finite or
/// beyond HiddenMaskLimits, or triangles are incomplete or have an invalid index.
std::pair<std::string, HiddenMask> hidden_mask_of(Change const& change);

} // namespace viewer
