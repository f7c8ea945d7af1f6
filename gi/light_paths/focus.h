#pragma once
// The part of a world that a picture shows, and that lights it nearly: a box for a fine grid.

#include "gi/render/exact_visibility.h"
#include "gi/render/frame_renderer.h"

#include <span>
#include <vector>

namespace gi {

/// A surface point, and the side that a ray hit.
struct ShownPoint {
    vec3 position; ///< m
    std::uint32_t triangle;
    bool front; ///< the counter-clockwise side
};

/// Surface points hit by rays from the cameras and by their continuations in random directions. The same rays for
/// the same cameras.  @param side  number of rays across and down each view  @param surfaces  number along a ray
std::vector<ShownPoint> shown_surfaces(World const& world, ExactVisibility const& visibility,
                                       std::span<FrameView const> views, int side, int surfaces);
/// Positions of the first two surfaces of 1,024 rays a view, m.
std::vector<vec3> shown_points(World const& world, ExactVisibility const& visibility,
                               std::span<FrameView const> views);
/// A box around all but 2 % of the points along each axis, and a margin of at least one and a half cells of its
/// field. Empty without points. @param voxels  along its longest side
Bounds focus_of(std::span<vec3 const> points, int voxels);
/// Longest side of a box, m; 0 if it is empty.
float longest_side(Bounds const& b);
/// True if what is shown is less than half as long as the world. An empty focus needs none.
bool needs_fine_grid(Bounds const& focus, Bounds const& world);
/// The part of focus_of() that lies within the world; empty unless the world is much larger.
Bounds focus_in(Bounds const& world, std::span<vec3 const> points, int voxels);
/// True if a box holds another.
bool holds(Bounds const& box, Bounds const& inner);
/// Share of the points in a box.
double share_in(Bounds const& box, std::span<vec3 const> points);

} // namespace gi
