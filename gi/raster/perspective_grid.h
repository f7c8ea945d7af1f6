#pragma once
// Raster of a pinhole view: a camera's picture or one face of the cube around a light point. Depth is the
// reciprocal of the distance along the view, 1/m, which is linear over the raster; larger is nearer. Triangles
// that reach behind the eye, or so far outside the raster that subpixels would overflow, are clipped one by one;
// all others are exact on snapped vertices as in grid.h.

#include "gi/raster/grid.h"
#include "gi/scene/model/camera.h"

namespace gi {

struct PerspectiveGrid {
    /// Corners farther than this many subpixels from zero are clipped.
    static constexpr float kGuard = 4194304; // 2^22

    vec3 eye{0};
    vec3 to_x{1, 0, 0}, to_y{0, 1, 0},
        forward{0, 0, 1}; ///< rows: (to_x . v) / (forward . v) is in subpixels, v from the eye
    float near_m = 0;
    float subpixels = 1;
    std::uint32_t width = 1, height = 1;

    mat3 inverse{1}; ///< from (x, y, w), with x and y in subpixels times w, to world directions

    GI_FN std::size_t texels() const { return std::size_t(width) * height; }
    /// Direction through the centre of texel (i, j), scaled to one metre along the view (not unit length).
    GI_FN vec3 direction(std::uint32_t i, std::uint32_t j) const
    {
        return inverse * vec3{(float(i) + 0.5f) * subpixels, (float(j) + 0.5f) * subpixels, 1};
    }
    /// @param depth 1 / distance along the view, 1/m
    GI_FN vec3 point(std::uint32_t i, std::uint32_t j, float depth) const { return eye + direction(i, j) / depth; }
};

/// @param at  sample position within each pixel, [0, 1)^2   @param near_m > 0
PerspectiveGrid camera_grid(CameraRays const& camera, int width, int height, vec2 at, float near_m);

/// Grid of face 0..5 (+X, -X, +Y, -Y, +Z, -Z) of the cube around a point: resolution^2 texels over 90 degrees.
PerspectiveGrid cube_face(vec3 eye, int face, std::uint32_t resolution, float near_m);

} // namespace gi
