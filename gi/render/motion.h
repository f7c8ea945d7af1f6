#pragma once
// Motion vectors: where the surface seen in each pixel was in the previous frame. For every method that records
// the triangle and the point first hit by a pixel's last path.

#include "gi/image_io/picture.h"
#include "gi/render/ray_query.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/model/world.h"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace gi {

using Corners = std::array<vec3, 3>;

/// Triangle positions in the previous frame.
struct EarlierCorners {
    std::size_t first_moving = 0; ///< index of the first triangle that may move
    std::vector<Corners> corners; ///< of the triangles from first_moving on; empty = nothing has moved
};

/// Returns the current corners of the triangles from `first` on.
std::vector<Corners> corners_of(World const& world, std::size_t first);

/// @param weights  of corners 1 and 2
inline vec3 point_on(Corners const& c, vec2 weights)
{
    return c[0] + weights.x * (c[1] - c[0]) + weights.y * (c[2] - c[0]);
}

/// The first surface of a pixel's last path.
struct SeenPoint {
    std::uint32_t triangle = kNoTriangle;
    vec2 weights{0};  ///< of corners 1 and 2
    vec3 position{0}; ///< now
};
/// Callback that fills in the points of a row of pixels; called from several threads.
using SeenRow = std::function<void(std::size_t y, std::span<SeenPoint> row)>;

/// Adds the layer "motion": x, y: offset in pixels from the current to the previous position; z: the previous
/// depth, m; NaN if the pixel shows no surface or the point was behind the camera. Static geometry before a
/// static camera gets exactly 0, 0.
void add_motion(SeenRow const& seen, CameraRays const& now, CameraRays const& camera_before,
                EarlierCorners const& before, Picture& picture);

} // namespace gi
