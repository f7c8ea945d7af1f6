#include "gi/hit_buffers/axis_pool.h"

#include "gi/core/error.h"
#include "gi/core/huge_pages.h"

#include <algorithm>
#include <cmath>

namespace gi {
namespace {

void pack(HitBuffer const& b, AxisPool& pool, std::uint32_t* to)
{
    float low = kInf, high = -kInf;
    for (HitLayer const& l : b.layers) {
        low = std::min(low, l.depth);
        high = std::max(high, l.depth);
    }
    constexpr float kSteps = 4095;
    float const step = high > low ? (high - low) / kSteps : 1;
    pool.packed_low.push_back(b.layers.empty() ? 0 : low);
    pool.packed_step.push_back(step);
    for (HitLayer const& l : b.layers) {
        std::uint32_t const triangle = l.primitive & kPrimitiveMask;
        if (triangle >= kPackedTriangles)
            throw InputError("packed layers hold 524288 triangles", "the scene has more", "leave out --packed");
        auto const depth = std::uint32_t(std::min(kSteps, std::round((l.depth - low) / step)));
        *to++ = depth << 20 | ((l.primitive & kAlongAxis) != 0 ? kPackedTriangles : 0) | triangle;
    }
}

} // namespace

AxisView AxisPool::axis(std::size_t a) const
{
    std::uint32_t const* const offsets = offset.data() + first_offset[a];
    std::size_t const texels = grids[a].texels();
    return {{{grids[a], {offsets, texels + 1}, {layers.data() + first_layer[a], offsets[texels]}}, {}}};
}

HitLayer AxisPool::layer(std::size_t a, std::uint32_t k) const
{
    if (packed.empty()) return layers[k];
    std::uint32_t const word = packed[k];
    return {float(word >> 20) * packed_step[a] + packed_low[a],
            ((word & kPackedTriangles) != 0 ? kAlongAxis : 0) | (word & (kPackedTriangles - 1))};
}

void fill_pool(std::vector<HitBuffer> const& buffers, AxisPool& pool, bool packed, BuildStop const& stop)
{
    pool.grids.clear();
    pool.ranges.clear();
    pool.first_moved = ~0u;
    pool.first_offset.clear();
    pool.first_layer.clear();
    std::size_t offsets = 0, layers = 0;
    for (HitBuffer const& b : buffers) {
        offsets += b.offset.size();
        layers += b.layers.size();
    }
    constexpr std::size_t kMost = 0x7fffffff;
    if (offsets > kMost || layers > kMost)
        throw InputError("the hit buffers have more than 2^31 layers", "they are indexed with 32 bits",
                         "lower the resolution or the number of directions");
    resize_on_huge_pages(pool.offset, offsets);
    resize_on_huge_pages(pool.layers, packed ? 0 : layers);
    resize_on_huge_pages(pool.packed, packed ? layers : 0);
    pool.packed_low.clear();
    pool.packed_step.clear();
    std::size_t offset = 0, layer = 0;
    for (HitBuffer const& b : buffers) {
        if (stop.given_up()) throw Interrupted();
        pool.grids.push_back(b.grid);
        pool.first_offset.push_back(std::uint32_t(offset));
        pool.first_layer.push_back(std::uint32_t(layer));
        std::ranges::copy(b.offset, pool.offset.data() + pool.first_offset.back());
        if (packed)
            pack(b, pool, pool.packed.data() + pool.first_layer.back());
        else
            std::ranges::copy(b.layers, pool.layers.data() + pool.first_layer.back());
        offset += b.offset.size();
        layer += b.layers.size();
    }
    if (packed && pool.packed.empty()) pool.packed.push_back(0);
    if (!packed && pool.layers.empty())
        pool.layers.push_back({}); // padding, as vectors may read beyond empty columns
}

} // namespace gi
