#pragma once
// Where a scene has mirrors and panes, to know when a picture shows none of them.

#include "gi/scene/model/world.h"

#include <span>

namespace gi {

/// Boxes of an instance's triangles of some materials, m, from the world's origin; infinite: they can move.
/// @param wanted  not 0 for these materials
std::vector<Bounds> mirror_boxes(World const& world, std::span<char const> wanted);

/// A part of a picture, px.
struct PixelBox {
    glm::ivec2 low{0}, high{0}; ///< high: behind the last ones
    bool empty() const { return low.x >= high.x || low.y >= high.y; }
};

/// Pixels that may show a place of a box. @param width, height  px
PixelBox pixels_of(Bounds const& box, CameraRays const& camera, int width, int height);

} // namespace gi
