#pragma once
// Raster of an orthographic view along an axis, with exact arithmetic that makes it watertight.
//
// Vertices are projected and snapped to whole subpixels: integers up to 2^22, which floats represent exactly (at
// 512 texels a subpixel is 1/4096 of a texel, the rounding error of the projection itself). Samples are texel
// centres. After snapping every decision is exact: triangles that share an edge or a vertex cover a sample exactly
// once between them, and a closed mesh has as many entering as leaving layers in every texel.

#include "gi/scene/model/world.h"

namespace gi {

struct RasterGrid {
    static constexpr int kCoordinateBits = 22;

    vec3 right{1, 0, 0}, up{0, 1, 0}, axis{0, 0, 1}; ///< orthonormal, axis = right x up
    vec2 corner{0};                                  ///< m, corner of texel (0, 0) along right and up
    float texel = 1;                                 ///< m, side of a texel
    std::uint32_t width = 1, height = 1;             ///< texels
    float subpixels = 1;                             ///< per texel, a power of two
    vec3 to_x{0}, to_y{0};                           ///< world to subpixels
    float x0 = 0, y0 = 0;
    float rounding = 0; ///< m; depths that differ by less count as equal

    GI_FN std::size_t texels() const { return std::size_t(width) * height; }
    GI_FN float project_x(vec3 p) const
    {
        return std::fma(p.z, to_x.z, std::fma(p.y, to_x.y, std::fma(p.x, to_x.x, x0)));
    }
    GI_FN float project_y(vec3 p) const
    {
        return std::fma(p.z, to_y.z, std::fma(p.y, to_y.y, std::fma(p.x, to_y.x, y0)));
    }
    /// Depth along the axis, m.
    GI_FN float depth(vec3 p) const { return std::fma(p.z, axis.z, std::fma(p.y, axis.y, p.x * axis.x)); }
    /// True if the texel under a point and those beside it are in the grid.
    GI_FN bool holds(vec3 p) const
    {
        float const x = (glm::dot(p, right) - corner.x) / texel, y = (glm::dot(p, up) - corner.y) / texel;
        return x >= 1 && y >= 1 && x < float(width) - 1 && y < float(height) - 1;
    }
    /// World point at a depth on the line through the centre of texel (i, j).
    GI_FN vec3 point(std::uint32_t i, std::uint32_t j, float depth_m) const
    {
        return (corner.x + (float(i) + 0.5f) * texel) * right + (corner.y + (float(j) + 0.5f) * texel) * up +
               depth_m * axis;
    }
};

/// Returns a grid of about resolution^2 square texels that covers the bounds seen along `axis` (unit).
/// @param jitter  [0, 1)^2, shift of the grid in texels   @param turn_rad  rotation of the grid about the axis
RasterGrid make_grid(Bounds const& bounds, vec3 axis, std::uint32_t resolution, vec2 jitter, float turn_rad);

/// As make_grid, over a window of a larger whole, whose triangles are drawn where they lie over the window. With a
/// whole of more than 2^20 texels, vertices are snapped to more than a quarter of a texel.
RasterGrid make_window(Bounds const& window, Bounds const& whole, vec3 axis, std::uint32_t resolution, vec2 jitter,
                       float turn_rad);

/// A projected triangle in whole subpixels.
struct SnappedTriangle {
    std::int32_t x[3], y[3];

    /// Twice the signed area; positive if the triangle winds counter-clockwise in (right, up), i.e. its normal
    /// points along the axis.
    GI_FN std::int64_t doubled_area() const
    {
        return std::int64_t(x[1] - x[0]) * (y[2] - y[0]) - std::int64_t(x[2] - x[0]) * (y[1] - y[0]);
    }
};

GI_FN inline SnappedTriangle snap(RasterGrid const& grid, vec3 a, vec3 b, vec3 c)
{
    return {{std::int32_t(std::rint(grid.project_x(a))), std::int32_t(std::rint(grid.project_x(b))),
             std::int32_t(std::rint(grid.project_x(c)))},
            {std::int32_t(std::rint(grid.project_y(a))), std::int32_t(std::rint(grid.project_y(b))),
             std::int32_t(std::rint(grid.project_y(c)))}};
}

/// Half plane to the left of an edge, over samples (i, j): value(i, j) >= 0 is inside. By the top-left rule, a
/// sample on the edge belongs to the triangle for which the edge runs downwards, or to the right if horizontal; so
/// it belongs to exactly one of the two triangles that share the edge.
struct HalfPlane {
    std::int64_t origin, step_i, step_j;

    GI_FN std::int64_t value(std::int64_t i, std::int64_t j) const { return origin + i * step_i + j * step_j; }
};

GI_FN inline HalfPlane half_plane(std::int32_t ax, std::int32_t ay, std::int32_t bx, std::int32_t by,
                                  std::int32_t subpixels)
{
    std::int64_t const dx = bx - ax, dy = by - ay, half = subpixels / 2;
    bool const owns_edge = dy < 0 || (dy == 0 && dx > 0);
    return {dx * (half - ay) - dy * (half - ax) - (owns_edge ? 0 : 1), -dy * subpixels, dx * subpixels};
}

/// Samples first..last whose centres lie within [low, high] subpixels, clamped to
/// 0..count - 1; empty if first > last.
struct SampleRange {
    std::int32_t first, last;
};

GI_FN inline SampleRange samples_between(std::int32_t low, std::int32_t high, std::int32_t subpixels,
                                         std::uint32_t count)
{
    // Arithmetic shifts would do; division rounds towards zero, so negative numbers are handled separately.
    std::int32_t const half = subpixels / 2;
    auto const floor_divide = [&](std::int32_t v) {
        return v >= 0 ? v / subpixels : -((-v + subpixels - 1) / subpixels);
    };
    std::int32_t const first = -floor_divide(half - low), last = floor_divide(high - half);
    return {first > 0 ? first : 0, last < std::int32_t(count) - 1 ? last : std::int32_t(count) - 1};
}

/// Bit in the primitive of a fragment or layer: set if its normal (counter-clockwise side) points along the axis.
inline constexpr std::uint32_t kAlongAxis = 0x80000000u;
inline constexpr std::uint32_t kPrimitiveMask = 0x3fffffffu;

} // namespace gi
