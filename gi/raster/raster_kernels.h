#pragma once
// Rasterisation kernels, one item per share of a triangle. Either the layers under every texel are counted and
// then filled in no particular order, or only the nearest one is kept. All decisions use integers and explicit
// fused multiply-adds, so that host and device give the same layers, bit for bit.
//
// A launch draws all triangles into several rasters, whose cells follow each other: a device is slow to begin, and a
// shadow map or an axis alone keeps it busy for less time than that. A large triangle is divided into shares of its
// bounds, so that no item has much more to do than others: a device waits for the longest. A launch has one item per
// raster and triangle, for its first share, and then those of all further shares; see raster_shares.h.

#include "gi/kernel/atomics.h"
#include "gi/raster/clip.h"
#include "gi/raster/hit_layer.h"
#include "gi/raster/nearest_map.h"
#include "gi/raster/scan_triangle.h"
#include "gi/raster/soup_view.h"

#include <bit>

namespace gi {

namespace raster_detail {

inline constexpr std::int32_t kShareColumns = 32, kShareRows = 4; ///< samples

GI_FN inline std::uint32_t parts(SampleRange const& r, std::int32_t of)
{
    return std::uint32_t((r.last - r.first + of) / of);
}

/// A triangle's share of the work in one raster.
struct Share {
    std::uint32_t raster, triangle;
    std::uint32_t index, all;
};

/// Calls `run` as scan() does, for one share of the bounds.
template <class Run>
GI_FN void scan_share(TriangleScan s, Share const& share, Run const& run)
{
    if (s.empty) return;
    std::uint32_t const across = glm::min(share.all, parts(s.columns, kShareColumns)), down = share.all / across,
                        row = share.index / across;
    if (row >= down) return;
    auto const part = [](SampleRange const& r, std::uint32_t k, std::uint32_t n) -> SampleRange {
        std::int64_t const all = r.last - r.first + 1;
        return {std::int32_t(r.first + all * k / n), std::int32_t(r.first + all * (k + 1) / n - 1)};
    };
    bool const small = s.columns.last - s.columns.first < 4; // columns; divisions would cost more than they save
    s.columns = part(s.columns, share.index % across, across);
    s.rows = part(s.rows, row, down);
    scan(s, small ? MacroPath::square_blocks : MacroPath::edge_table, run);
}

/// Calls emit(SnappedTriangle, depths) for each projected (and possibly clipped) part of a triangle.
template <class Emit>
GI_FN void project(RasterGrid const& grid, vec3 const* p, Emit const& emit)
{
    emit(snap(grid, p[0], p[1], p[2]), vec3{grid.depth(p[0]), grid.depth(p[1]), grid.depth(p[2])});
}

template <class Emit>
GI_FN void project(PerspectiveGrid const& grid, vec3 const* p, Emit const& emit)
{
    auto const row = [](vec3 v, vec3 to) { return std::fma(v.z, to.z, std::fma(v.y, to.y, v.x * to.x)); };
    float x[3], y[3], z[3], nearest = kInf, farthest = -kInf, widest = 0;
    for (int k = 0; k < 3; ++k) {
        vec3 const v = p[k] - grid.eye;
        float const w = row(v, grid.forward);
        nearest = glm::min(nearest, w);
        farthest = glm::max(farthest, w);
        z[k] = 1 / w;
        x[k] = std::rint(row(v, grid.to_x) * z[k]);
        y[k] = std::rint(row(v, grid.to_y) * z[k]);
        widest = glm::max(widest, glm::max(std::abs(x[k]), std::abs(y[k])));
    }
    if (farthest <= grid.near_m) return;
    if (!(nearest > grid.near_m && widest <= PerspectiveGrid::kGuard)) {
        clip_triangle(grid, p, emit);
        return;
    }
    auto const whole = [](float v) { return std::int32_t(v); };
    emit(SnappedTriangle{{whole(x[0]), whole(x[1]), whole(x[2])}, {whole(y[0]), whole(y[1]), whole(y[2])}},
         vec3{z[0], z[1], z[2]});
}

/// Maps a float to an integer that sorts in the same order; never 0.
GI_FN inline std::uint32_t ordered_bits(float v)
{
    auto const bits = std::bit_cast<std::uint32_t>(v + 0.0f); // -0 is 0
    return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

GI_FN inline float from_ordered_bits(std::uint32_t ordered)
{
    return std::bit_cast<float>((ordered & 0x80000000u) != 0 ? ordered & 0x7fffffffu : ~ordered);
}

GI_FN inline float key_sign(RasterGrid const&) { return -1; }
GI_FN inline float key_sign(PerspectiveGrid const&) { return 1; }

} // namespace raster_detail

/// A raster into which the nearest surfaces are drawn.
template <class Grid>
struct NearestRaster {
    Grid grid;
    std::uint32_t first_cell; ///< its first texel among those of a launch
    std::uint32_t seed;       ///< of cut-outs, see KeepUncut
    NearestTexel* texels;     ///< row-major
};

/// A raster into which layers are drawn. It has a cell more than texels, so that sums over the cells before give the
/// ends of columns too.
struct LayerRaster {
    RasterGrid grid;
    std::uint32_t first_cell;
    std::uint32_t seed;
    std::uint32_t* offset; ///< texels + 1
    HitLayer* layers;
};

/// The raster of a cell, which is the last one that begins at or before it.
template <class Raster>
GI_FN std::uint32_t raster_of_cell(View<Raster const> rasters, std::size_t cell)
{
    std::uint32_t first = 0, last = std::uint32_t(rasters.size());
    while (last - first > 1) {
        std::uint32_t const middle = (first + last) / 2;
        (rasters[middle].first_cell <= cell ? first : last) = middle;
    }
    return first;
}

/// The shares of all triangles in all rasters.
struct SharesView {
    View<std::uint32_t const>
        before; ///< pairs of raster and triangle + 1: further shares of the pairs before each
    std::uint32_t triangles;

    GI_FN raster_detail::Share share(std::size_t item) const
    {
        std::size_t const pairs = before.size() - 1;
        std::size_t pair = item;
        std::uint32_t index = 0;
        if (item >= pairs) { // the last pair that has no more before it than there are before the item
            auto const further = std::uint32_t(item - pairs);
            std::size_t first = 0, last = pairs;
            while (last - first > 1) {
                std::size_t const middle = (first + last) / 2;
                (before[middle] <= further ? first : last) = middle;
            }
            pair = first;
            index = 1 + further - before[first];
        }
        auto const raster = std::uint32_t(pair) / triangles;
        return {raster, std::uint32_t(pair) - raster * triangles, index, 1 + before[pair + 1] - before[pair]};
    }
};

/// Item = pair of raster and triangle, and one more. How many shares it has besides the first.
template <class Raster>
struct CountShares {
    SoupView soup;
    View<Raster const> rasters;
    std::uint32_t most; ///< shares of a triangle, so that the sum has 32 bits
    View<std::uint32_t> further;

    GI_FN void operator()(std::size_t pair) const
    {
        using namespace raster_detail;
        if (pair + 1 == further.size()) {
            further[pair] = 0;
            return;
        }
        auto const triangles = std::uint32_t(soup.count), raster = std::uint32_t(pair) / triangles;
        std::size_t const t = std::uint32_t(pair) - raster * triangles;
        auto const& grid = rasters[raster].grid;
        vec3 const p[3] = {soup.vertex(t, 0), soup.vertex(t, 1), soup.vertex(t, 2)};
        std::uint32_t shares = 1;
        project(grid, p, [&](SnappedTriangle const& part, vec3) {
            TriangleScan const s = start_scan(part, std::int32_t(grid.subpixels), grid.width, grid.height);
            if (!s.empty) shares = glm::max(shares, parts(s.columns, kShareColumns) * parts(s.rows, kShareRows));
        });
        further[pair] = glm::min(shares, most) - 1;
    }
};

/// Item = share of a triangle. Counts its layers under each texel.
struct CountLayers {
    SoupView soup;
    View<LayerRaster const> rasters;
    SharesView shares;
    View<std::uint32_t> count; ///< per cell
    View<std::uint64_t> total; ///< per raster, in 64 bits because the 32-bit counts can wrap

    GI_FN void operator()(std::size_t i) const
    {
        raster_detail::Share const share = shares.share(i);
        std::size_t const t = share.triangle;
        RasterGrid const& grid = rasters[share.raster].grid;
        std::size_t const base = rasters[share.raster].first_cell;
        SnappedTriangle const snapped = snap(grid, soup.vertex(t, 0), soup.vertex(t, 1), soup.vertex(t, 2));
        TriangleScan const s = start_scan(snapped, std::int32_t(grid.subpixels), grid.width, grid.height);
        std::uint64_t sum = 0;
        raster_detail::scan_share(s, share, [&](std::uint32_t row, std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t c = first; c <= last; ++c)
                atomic_add(count[base + std::size_t(row) * grid.width + c], 1);
            sum += last - first + 1;
        });
        if (sum > 0) atomic_add(total[share.raster], sum);
    }
};

/// Item = cell. From the sums over the cells before, which may wrap, to the offsets of each raster by itself.
struct StartLayers {
    View<LayerRaster const> rasters;
    View<std::uint32_t const> before;
    View<std::uint32_t> next;  ///< the same again, for FillLayers; empty = not needed
    View<std::uint32_t> total; ///< per raster: all its layers; empty = not needed

    GI_FN void operator()(std::size_t cell) const
    {
        std::uint32_t const of = raster_of_cell(rasters, cell);
        LayerRaster const& raster = rasters[of];
        std::size_t const t = cell - raster.first_cell;
        std::uint32_t const offset = before[cell] - before[raster.first_cell];
        raster.offset[t] = offset;
        if (!next.empty()) next[cell] = offset;
        if (!total.empty() && t == raster.grid.texels()) total[of] = offset;
    }
};

/// Item = share of a triangle. Writes its layers into the ranges that StartLayers computed.
struct FillLayers {
    SoupView soup;
    View<LayerRaster const> rasters;
    SharesView shares;
    View<std::uint32_t> next; ///< per cell: next free layer; after the launch, the end of its layers

    GI_FN void operator()(std::size_t i) const
    {
        raster_detail::Share const share = shares.share(i);
        std::size_t const t = share.triangle;
        RasterGrid const& grid = rasters[share.raster].grid;
        std::size_t const base = rasters[share.raster].first_cell;
        HitLayer* const layers = rasters[share.raster].layers;
        vec3 const a = soup.vertex(t, 0), b = soup.vertex(t, 1), c = soup.vertex(t, 2);
        SnappedTriangle const snapped = snap(grid, a, b, c);
        auto const subpixels = std::int32_t(grid.subpixels);
        TriangleScan const s = start_scan(snapped, subpixels, grid.width, grid.height);
        if (s.empty) return;
        DepthPlane const plane = depth_plane(snapped, subpixels, {grid.depth(a), grid.depth(b), grid.depth(c)});
        std::uint32_t const id = std::uint32_t(t) | (s.along ? kAlongAxis : 0);
        raster_detail::scan_share(s, share, [&](std::uint32_t row, std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t column = first; column <= last; ++column)
                layers[atomic_add(next[base + std::size_t(row) * grid.width + column], 1)] = {
                    plane.at(column, row), id};
        });
    }
};

/// Accepts every fragment.
struct KeepAll {
    GI_FN KeepAll seeded(std::uint32_t) const { return {}; }
    template <class Grid>
    GI_FN bool operator()(Grid const&, std::uint32_t, std::uint32_t, float) const
    {
        return true;
    }
};

/// Item = share of a triangle. Keeps the nearest fragment of each texel; ties go to the triangle of lower index.
/// Fragments for which all.seeded(seed of the raster)(grid, triangle, texel, depth) is false are ignored.
template <class Grid, class Keep>
struct DrawNearest {
    SoupView soup;
    View<NearestRaster<Grid> const> rasters;
    Keep all;
    SharesView shares;
    View<std::uint64_t> best; ///< per cell: key in the upper half, inverted triangle in the lower; 0 = none

    GI_FN void operator()(std::size_t i) const
    {
        raster_detail::Share const share = shares.share(i);
        std::size_t const t = share.triangle;
        Grid const& grid = rasters[share.raster].grid;
        std::size_t const base = rasters[share.raster].first_cell;
        Keep const keep = all.seeded(rasters[share.raster].seed);
        vec3 const p[3] = {soup.vertex(t, 0), soup.vertex(t, 1), soup.vertex(t, 2)};
        auto const subpixels = std::int32_t(grid.subpixels);
        auto const id = std::uint32_t(t);
        raster_detail::project(grid, p, [&](SnappedTriangle const& part, vec3 depths) {
            TriangleScan const s = start_scan(part, subpixels, grid.width, grid.height);
            if (s.empty) return;
            DepthPlane const plane = depth_plane(part, subpixels, depths);
            raster_detail::scan_share(s, share, [&](std::uint32_t row, std::uint32_t first, std::uint32_t last) {
                for (std::uint32_t column = first; column <= last; ++column) {
                    std::uint32_t const texel = row * grid.width + column;
                    float const depth = plane.at(column, row);
                    if (!keep(grid, id, texel, depth)) continue;
                    std::uint64_t const key = raster_detail::ordered_bits(raster_detail::key_sign(grid) * depth);
                    atomic_max(best[base + texel], key << 32 | (~id & 0xffffffffu));
                }
            });
        });
    }
};

/// Item = cell. Converts the result of DrawNearest to the texels of a NearestMap.
template <class Grid>
struct UnpackNearest {
    View<NearestRaster<Grid> const> rasters;
    View<std::uint64_t const> best;

    GI_FN void operator()(std::size_t i) const
    {
        NearestTexel t;
        if (best[i] != 0)
            t = {raster_detail::from_ordered_bits(std::uint32_t(best[i] >> 32)), ~std::uint32_t(best[i])};
        NearestRaster<Grid> const& raster = rasters[raster_of_cell(rasters, i)];
        raster.texels[i - raster.first_cell] = t;
    }
};

} // namespace gi
