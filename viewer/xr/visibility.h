#pragma once
// Parts of an eye's picture that its lens never shows (XR_KHR_visibility_mask): need not be rendered.

#include "gi/scene/camera.h"

#include <cstdint>
#include <vector>

namespace viewer {

/// Triangles that cover what is hidden, in the plane one metre before the eye: x to the right, y up, as tangents.
struct HiddenMask {
    std::vector<gi::vec2> points;
    std::vector<std::uint32_t> triangles; ///< three indices each
    std::uint64_t version = 0;            ///< 0: the runtime has told nothing

    bool operator==(HiddenMask const&) const = default;
};

/// 1 per pixel whose middle is hidden, rows from the top. Triangles with an index past the points are left out.
std::vector<std::uint8_t> hidden_pixels(HiddenMask const& mask, gi::ViewTangents const& view, int width,
                                        int height);

} // namespace viewer
