#include "gi/raster/perspective_grid.h"

#include <bit>

namespace gi {
namespace {

/// With corners inside the guard band and samples inside the raster, this leaves 4 times the raster on all sides.
float subpixels_for(std::uint32_t width, std::uint32_t height)
{
    int const bits = int(std::bit_width(std::max(width, height)));
    return float(1u << std::max(2, 20 - bits));
}

void add_inverse(PerspectiveGrid& g)
{
    using glm::dmat3;
    g.inverse = mat3(glm::inverse(glm::transpose(dmat3(g.to_x, g.to_y, g.forward))));
}

} // namespace

PerspectiveGrid camera_grid(CameraRays const& camera, int width, int height, vec2 at, float near_m)
{
    PerspectiveGrid g;
    g.width = std::uint32_t(width);
    g.height = std::uint32_t(height);
    g.subpixels = subpixels_for(g.width, g.height);
    g.eye = camera.origin;
    g.forward = camera.forward;
    g.near_m = near_m;
    // Inverse of CameraRays::through: v / w = corner + x step_x + y step_y.
    auto const row = [&](vec3 step, float shift) {
        vec3 const unit = step / glm::dot(step, step);
        return g.subpixels * (unit + (shift - glm::dot(camera.corner, unit)) * camera.forward);
    };
    g.to_x = row(camera.step_x, 0.5f - at.x);
    g.to_y = row(camera.step_y, 0.5f - at.y);
    add_inverse(g);
    return g;
}

PerspectiveGrid cube_face(vec3 eye, int face, std::uint32_t resolution, float near_m)
{
    PerspectiveGrid g;
    g.eye = eye;
    g.width = g.height = resolution;
    g.subpixels = subpixels_for(resolution, resolution);
    g.near_m = near_m;
    int const axis = face / 2;
    g.forward = vec3{0};
    g.forward[axis] = face % 2 == 0 ? 1.0f : -1.0f;
    float const half = 0.5f * float(resolution) * g.subpixels;
    vec3 u{0}, v{0};
    u[(axis + 1) % 3] = half;
    v[(axis + 2) % 3] = half;
    g.to_x = u + half * g.forward;
    g.to_y = v + half * g.forward;
    add_inverse(g);
    return g;
}

} // namespace gi
