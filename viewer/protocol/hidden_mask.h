#pragma once
// Parts of a view that nobody sees, as those of an eye that its lens never shows (XR_KHR_visibility_mask): they
// are not rendered. A session is told by a Change with the key "hidden.VIEW" and the value
//   {"points": [[x, y], ...], "triangles": [i, j, k, ...]}
// where points are tangents as below; no triangles = nothing of that view is hidden.

#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Triangles that cover what is hidden, in the plane one metre before the eye: x to the right, y up, as tangents.
struct HiddenMask {
    std::vector<gi::vec2> points;         ///< finite
    std::vector<std::uint32_t> triangles; ///< three indices each

    bool operator==(HiddenMask const&) const = default;
};

/// What a mask may hold at most, so that its text stays within CommandLimits::value_bytes.
struct HiddenMaskLimits {
    static constexpr std::size_t points = 8192, triangles = 16384;
    static constexpr double tangent = 1e4;
};

/// The last picture is shown as seen from where the head is now (viewer/devices/gl/reprojection.h), which brings
/// pixels from beyond the border of what is seen into sight. So what is rendered reaches past that border by this
/// much, as a tangent: a head that turns by 30 degrees per second, over the 50 ms between two pictures, moves what
/// lies 45 degrees off the axis by 1.5 degrees / cos^2(45 degrees) = 0.052.
inline constexpr double kHiddenGuard = 0.052;
/// No less than that many pixels: the windows of temporal reuse and of the filter around what is seen.
inline constexpr int kHiddenGuard_px = 4;

/// 1 per pixel whose middle is hidden, rows from the top. Triangles with an index past the points are left out.
/// @param view  width and height of the picture fill it
std::vector<std::uint8_t> hidden_pixels(HiddenMask const& mask, gi::ViewTangents const& view, int width,
                                        int height);
/// The same but for pixels with one that is seen nearer than kHiddenGuard and kHiddenGuard_px: these that need not
/// be rendered. Beyond the picture nothing is seen.
std::vector<std::uint8_t> pixels_to_leave_out(HiddenMask const& mask, gi::ViewTangents const& view, int width,
                                              int height);

/// Whether a key names the mask of a view.
bool is_hidden_mask(std::string const& key);
Change hidden_change(std::string const& view, HiddenMask const& mask);
/// View and mask of such a change. Throws InputError on another value, on numbers that are not finite or beyond
/// HiddenMaskLimits, triangles that are not whole or name no point.
std::pair<std::string, HiddenMask> hidden_mask_of(Change const& change);

} // namespace viewer
