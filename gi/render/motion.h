#pragma once
// Motion vectors: where the surface under each pixel was in the frame before. For every method that knows the
// triangle and the point that a pixel's last path met first.

#include "gi/image_io/picture.h"
#include "gi/render/exact_visibility.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/model/world.h"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace gi {

using Corners = std::array<vec3, 3>;

/// Where triangles were in the frame before.
struct EarlierCorners {
    std::size_t first_moving = 0; ///< triangle
    std::vector<Corners> corners; ///< of triangles from there on; empty = none has moved
};

/// The corners of triangles from `first` on, as they are now.
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
/// Sets the points of a row of pixels; called from several threads.
using SeenRow = std::function<void(std::size_t y, std::span<SeenPoint> row)>;

/// Adds the layer "motion": x, y in pixels from here to there, z the depth it had there, m; NaN where nothing is
/// seen or it was behind the camera. What stands still before a camera that stands still has 0, 0 exactly.
void add_motion(SeenRow const& seen, CameraRays const& now, CameraRays const& camera_before,
                EarlierCorners const& before, Picture& picture);

} // namespace gi
