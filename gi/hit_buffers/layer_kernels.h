#pragma once
// Kernels that turn filled layers into a hit buffer and look up in it: sort, trim, pack, look up.
//
// One item sorts one texel: insertion sort for few layers, else in-place heap sort, so that 10,000 layers under
// one texel (a needle seen along its length) take n log n steps and no extra memory. Order: depth, then
// primitive, as in fill_hit_buffer; this order is total, so that all spaces give the same buffer.

#include "gi/kernel/atomics.h"
#include "gi/hit_buffers/query.h"

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

/// Item = texel.
struct SortLayers {
    View<std::uint32_t const> offset; ///< texels + 1
    View<HitLayer> layers;

    GI_FN void operator()(std::size_t t) const
    {
        constexpr std::size_t kFew = 24;
        HitLayer* const first = layers.data + offset[t];
        std::size_t const n = offset[t + 1] - offset[t];
        if (n <= kFew)
            layer_detail::sort_by_insertion(first, n);
        else
            layer_detail::sort_as_heap(first, n);
    }
};

/// Item = texel. Moves the layers accepted by Keep(grid, triangle, texel, depth) to the front of the texel, at
/// most `most`, and counts them.
template <class Keep>
struct TrimLayers {
    RasterGrid grid;
    Keep keep;
    std::uint32_t most;               ///< 0 = all
    View<std::uint32_t const> offset; ///< texels + 1
    View<HitLayer> layers;            ///< sorted
    View<std::uint32_t> kept;         ///< per texel
    View<std::uint64_t> lost;         ///< one number: layers beyond `most`

    GI_FN void operator()(std::size_t t) const
    {
        std::uint32_t n = 0, beyond = 0;
        HitLayer* const out = layers.data + offset[t];
        for (std::uint32_t k = offset[t]; k < offset[t + 1]; ++k) {
            HitLayer const layer = layers[k];
            if (!keep(grid, layer.primitive & kPrimitiveMask, std::uint32_t(t), layer.depth)) continue;
            if (most > 0 && n == most)
                ++beyond;
            else
                out[n++] = layer;
        }
        kept[t] = n;
        if (beyond > 0) atomic_add(lost[0], beyond);
    }
};

/// Item = texel. Copies the front layers of every texel to a compact array.
struct PackLayers {
    View<std::uint32_t const> from_offset, to_offset;
    View<HitLayer const> from;
    View<HitLayer> to;

    GI_FN void operator()(std::size_t t) const
    {
        std::uint32_t const n = to_offset[t + 1] - to_offset[t];
        for (std::uint32_t k = 0; k < n; ++k) to[to_offset[t] + k] = from[from_offset[t] + k];
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
