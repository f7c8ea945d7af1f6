#pragma once
// Kernels that turn filled layers into a hit buffer and look up in it: sort, trim, pack, look up.
//
// One item sorts one texel: insertion sort for few layers, else in-place heap sort, so that 10,000 layers under
// one texel (a needle seen along its length) take n log n steps and no extra memory. Order: depth, then
// primitive, as in fill_hit_buffer; this order is total, so that all spaces give the same buffer.

#include "gi/hit_buffers/query.h"
#include "gi/kernel/atomics.h"
#include "gi/raster/raster_kernels.h"

namespace gi {

namespace layer_detail {

GI_FN inline void swap(HitLayer& a, HitLayer& b)
{
    HitLayer const t = a;
    a = b;
    b = t;
}

GI_FN inline void sort_by_insertion(HitLayer* v, std::size_t n)
{
    for (std::size_t i = 1; i < n; ++i) {
        HitLayer const moved = v[i];
        std::size_t to = i;
        for (; to > 0 && before(moved, v[to - 1]); --to) v[to] = v[to - 1];
        v[to] = moved;
    }
}

/// Sifts v[root] down in a max-heap of n elements.
GI_FN inline void sink(HitLayer* v, std::size_t root, std::size_t n)
{
    HitLayer const moved = v[root];
    for (std::size_t child = 2 * root + 1; child < n; child = 2 * root + 1) {
        if (child + 1 < n && before(v[child], v[child + 1])) ++child;
        if (!before(moved, v[child])) break;
        v[root] = v[child];
        root = child;
    }
    v[root] = moved;
}

GI_FN inline void sort_as_heap(HitLayer* v, std::size_t n)
{
    for (std::size_t root = n / 2; root-- > 0;) sink(v, root, n);
    for (std::size_t last = n; --last > 0;) {
        swap(v[0], v[last]);
        sink(v, 0, last);
    }
}

} // namespace layer_detail

/// Item = cell of several rasters. The last one of each has no texel.
struct SortLayers {
    View<LayerRaster const> rasters;

    GI_FN void operator()(std::size_t cell) const
    {
        constexpr std::size_t kFew = 24;
        LayerRaster const& raster = rasters[raster_of_cell(rasters, cell)];
        std::size_t const t = cell - raster.first_cell;
        if (t == raster.grid.texels()) return;
        HitLayer* const first = raster.layers + raster.offset[t];
        std::size_t const n = raster.offset[t + 1] - raster.offset[t];
        if (n <= kFew)
            layer_detail::sort_by_insertion(first, n);
        else
            layer_detail::sort_as_heap(first, n);
    }
};

/// Item = cell. Moves the sorted layers accepted by all.seeded(seed)(grid, triangle, texel, depth) to the front of the
/// texel, at most `most`, and counts them.
template <class Keep>
struct TrimLayers {
    View<LayerRaster const> rasters;
    Keep all;
    std::uint32_t most;       ///< 0 = all
    View<std::uint32_t> kept; ///< per cell
    View<std::uint64_t> lost; ///< per raster: layers beyond `most`

    GI_FN void operator()(std::size_t cell) const
    {
        std::uint32_t const of = raster_of_cell(rasters, cell);
        LayerRaster const& raster = rasters[of];
        RasterGrid const& grid = raster.grid;
        std::size_t const t = cell - raster.first_cell;
        kept[cell] = 0;
        if (t == grid.texels()) return;
        Keep const keep = all.seeded(raster.seed);
        std::uint32_t n = 0, beyond = 0;
        HitLayer* const out = raster.layers + raster.offset[t];
        for (std::uint32_t k = raster.offset[t]; k < raster.offset[t + 1]; ++k) {
            HitLayer const layer = raster.layers[k];
            if (!keep(grid, layer.primitive & kPrimitiveMask, std::uint32_t(t), layer.depth)) continue;
            if (most > 0 && n == most)
                ++beyond;
            else
                out[n++] = layer;
        }
        kept[cell] = n;
        if (beyond > 0) atomic_add(lost[of], beyond);
    }
};

/// Item = cell. Copies the front layers of every texel to a compact array.
struct PackLayers {
    View<LayerRaster const> from, to; ///< the same grids

    GI_FN void operator()(std::size_t cell) const
    {
        std::uint32_t const of = raster_of_cell(from, cell);
        LayerRaster const &source = from[of], &packed = to[of];
        std::size_t const t = cell - source.first_cell;
        if (t == source.grid.texels()) return;
        HitLayer const* const in = source.layers + source.offset[t];
        HitLayer* const out = packed.layers + packed.offset[t];
        std::uint32_t const n = packed.offset[t + 1] - packed.offset[t];
        for (std::uint32_t k = 0; k < n; ++k) out[k] = in[k];
    }
};

/// Item = look-up. Arrays as in QueryBatch.
struct AnswerQueries {
    View<AxisView const> axes;
    View<Surface const> surfaces;
    View<float const> x, y, z;
    View<std::uint32_t const> triangle; ///< of the origin, with kAlongAxis and kWalkUp
    View<float const> slope;
    View<std::uint32_t const> axis;
    View<float> hit_x, hit_y, hit_z;
    View<std::uint32_t> hit; ///< triangle with kAlongAxis, or kNoLayerHit

    GI_FN void operator()(std::size_t i) const
    {
        std::uint32_t const from = triangle[i];
        WalkOrigin const origin{
            {x[i], y[i], z[i]}, from & kPrimitiveMask, (from & kAlongAxis) != 0, (from & kWalkUp) != 0, slope[i]};
        LayerHit const h = nearest_layer(axes[axis[i]], surfaces, origin);
        hit[i] = h.triangle == kNoLayerHit ? kNoLayerHit : h.triangle | (h.along ? kAlongAxis : 0);
        hit_x[i] = h.position.x;
        hit_y[i] = h.position.y;
        hit_z[i] = h.position.z;
    }
};

} // namespace gi
