#pragma once
// Scalar rasteriser, one triangle at a time, which runs on every device and is the reference for the fast
// versions, with three ways to traverse a large triangle (Yu 2012, sec. 4.4.4).
//
// Each traversal calls run(j, first, last) for the samples first..last of row j that the triangle covers, every
// covered sample once. All are exact (see grid.h).

#include "gi/raster/grid.h"

namespace gi {

enum class MacroPath : std::uint8_t {
    edge_table,    ///< intersects each row with the edges (fig. 4.9)
    linear_blocks, ///< rows of the bounding box in runs of 16 samples (fig. 4.8)
    square_blocks, ///< blocks of 4 x 4: outside, inside, or sample by sample (fig. 4.7). Edges are tested at the
                   ///< block corner farthest inside, so that a triangle within a block is found even if it covers
                   ///< none of the block's corners
};

/// A triangle ready for scanning.
struct TriangleScan {
    HalfPlane edge[3];
    SampleRange columns, rows;
    bool along = false; ///< the triangle's normal points along the axis
    bool empty = true;  ///< no area, or no sample within its bounds
};

GI_FN inline TriangleScan start_scan(SnappedTriangle const& t, std::int32_t subpixels, std::uint32_t width,
                                     std::uint32_t height)
{
    TriangleScan s;
    std::int64_t const area = t.doubled_area();
    if (area == 0) return s;
    s.along = area > 0;
    auto const lowest = [](std::int32_t const* v) { return glm::min(v[0], glm::min(v[1], v[2])); };
    auto const highest = [](std::int32_t const* v) { return glm::max(v[0], glm::max(v[1], v[2])); };
    s.columns = samples_between(lowest(t.x), highest(t.x), subpixels, width);
    s.rows = samples_between(lowest(t.y), highest(t.y), subpixels, height);
    s.empty = s.columns.first > s.columns.last || s.rows.first > s.rows.last;
    int const second = s.along ? 1 : 2, third = s.along ? 2 : 1; // counter-clockwise
    s.edge[0] = half_plane(t.x[second], t.y[second], t.x[third], t.y[third], subpixels);
    s.edge[1] = half_plane(t.x[third], t.y[third], t.x[0], t.y[0], subpixels);
    s.edge[2] = half_plane(t.x[0], t.y[0], t.x[second], t.y[second], subpixels);
    return s;
}

/// Floor of a / b for b > 0.
GI_FN inline std::int64_t floor_divide(std::int64_t a, std::int64_t b)
{
    std::int64_t const q = a / b;
    return q - (a % b < 0 ? 1 : 0);
}

template <class Run>
GI_FN void scan_edge_table(TriangleScan const& s, Run const& run)
{
    for (std::int64_t j = s.rows.first; j <= s.rows.last; ++j) {
        std::int64_t first = s.columns.first, last = s.columns.last;
        for (HalfPlane const& e : s.edge) {
            std::int64_t const at_zero = e.origin + j * e.step_j;
            if (e.step_i > 0)
                first = glm::max(first, -floor_divide(at_zero, e.step_i));
            else if (e.step_i < 0)
                last = glm::min(last, floor_divide(at_zero, -e.step_i));
            else if (at_zero < 0)
                last = -1;
        }
        if (first <= last) run(std::uint32_t(j), std::uint32_t(first), std::uint32_t(last));
    }
}

template <class Run>
GI_FN void scan_linear_blocks(TriangleScan const& s, Run const& run)
{
    constexpr int kBlock = 16;
    for (std::int64_t j = s.rows.first; j <= s.rows.last; ++j)
        for (std::int64_t i = s.columns.first; i <= s.columns.last; i += kBlock) {
            std::int64_t const e0 = s.edge[0].value(i, j), e1 = s.edge[1].value(i, j), e2 = s.edge[2].value(i, j);
            std::uint8_t outside[kBlock];
            for (int k = 0; k < kBlock; ++k)
                outside[k] = std::uint8_t(
                    ((e0 + k * s.edge[0].step_i) | (e1 + k * s.edge[1].step_i) | (e2 + k * s.edge[2].step_i)) < 0);
            int const count = int(glm::min(std::int64_t(kBlock), s.columns.last - i + 1));
            int first = 0, last = count - 1;
            while (first < count && outside[first] != 0) ++first;
            while (last > first && outside[last] != 0) --last;
            if (first < count) run(std::uint32_t(j), std::uint32_t(i + first), std::uint32_t(i + last));
        }
}

template <class Run>
GI_FN void scan_square_blocks(TriangleScan const& s, Run const& run)
{
    constexpr std::int64_t kSide = 4;
    for (std::int64_t top = s.rows.first; top <= s.rows.last; top += kSide)
        for (std::int64_t left = s.columns.first; left <= s.columns.last; left += kSide) {
            std::int64_t const height = glm::min(kSide, s.rows.last - top + 1);
            std::int64_t const width = glm::min(kSide, s.columns.last - left + 1);
            bool outside = false, inside = true;
            for (HalfPlane const& e : s.edge) {
                std::int64_t const corner = e.value(left, top);
                std::int64_t const across = (width - 1) * e.step_i, down = (height - 1) * e.step_j;
                std::int64_t const zero = 0;
                outside |= corner + glm::max(zero, across) + glm::max(zero, down) < 0;
                inside &= corner + glm::min(zero, across) + glm::min(zero, down) >= 0;
            }
            if (outside) continue;
            for (std::int64_t j = top; j < top + height; ++j) {
                std::int64_t first = left, last = left + width - 1;
                auto const covered = [&](std::int64_t i) {
                    return (s.edge[0].value(i, j) | s.edge[1].value(i, j) | s.edge[2].value(i, j)) >= 0;
                };
                if (!inside) {
                    while (first <= last && !covered(first)) ++first;
                    while (last > first && !covered(last)) --last;
                }
                if (first <= last) run(std::uint32_t(j), std::uint32_t(first), std::uint32_t(last));
            }
        }
}

template <class Run>
GI_FN void scan(TriangleScan const& s, MacroPath path, Run const& run)
{
    if (s.empty) return;
    if (path == MacroPath::edge_table)
        scan_edge_table(s, run);
    else if (path == MacroPath::linear_blocks)
        scan_linear_blocks(s, run);
    else
        scan_square_blocks(s, run);
}

/// Depth at the samples of a triangle: its plane, clamped between the depths of its corners so that triangles seen
/// edge-on get no extreme values. Explicit fused multiply-adds make all compilers round identically.
struct DepthPlane {
    double at_zero, step_i, step_j; ///< at sample (0, 0), per sample
    float low, high;

    GI_FN float at(std::uint32_t i, std::uint32_t j) const
    {
        return glm::clamp(float(std::fma(double(i), step_i, std::fma(double(j), step_j, at_zero))), low, high);
    }
};

/// @param t must have a non-zero area   @param depth of the three corners
GI_FN inline DepthPlane depth_plane(SnappedTriangle const& t, std::int32_t subpixels, vec3 depth)
{
    double const x1 = t.x[1] - t.x[0], y1 = t.y[1] - t.y[0], z1 = double(depth.y) - double(depth.x);
    double const x2 = t.x[2] - t.x[0], y2 = t.y[2] - t.y[0], z2 = double(depth.z) - double(depth.x);
    double const scale = subpixels / double(t.doubled_area());
    DepthPlane p;
    p.step_i = std::fma(z1, y2, -(z2 * y1)) * scale;
    p.step_j = std::fma(z2, x1, -(z1 * x2)) * scale;
    p.at_zero = std::fma(p.step_i, 0.5 - double(t.x[0]) / subpixels,
                         std::fma(p.step_j, 0.5 - double(t.y[0]) / subpixels, double(depth.x)));
    p.low = glm::min(depth.x, glm::min(depth.y, depth.z));
    p.high = glm::max(depth.x, glm::max(depth.y, depth.z));
    return p;
}

} // namespace gi
