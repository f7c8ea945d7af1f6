#pragma once
// The hit buffers of several axes in a few arrays.

#include "gi/methods/slhb/hit_buffer/query.h"

namespace gi {

/// Layers of one texel, from the axis' first layer on.
struct LayerRange {
    std::uint32_t begin, end;
};

/// The buffers of several axes in a few arrays, so that one vector can walk along many axes.
struct AxisPool {
    std::vector<RasterGrid> grids;
    std::vector<std::uint32_t> first_offset, first_layer; ///< of each axis
    std::vector<std::uint32_t> offset; ///< per axis texels + 1 entries, from the axis' first layer on
    std::vector<HitLayer> layers;      ///< of all axes; then those of moving_layers.h
    /// Where something moves, in place of `offset` and numbered as that: the columns, wherever they lie.
    std::vector<LayerRange> ranges;
    bool without_moving = false;     ///< `ranges` are not read: columns are as if nothing of what moves was there
    std::uint32_t first_moved = ~0u; ///< layers from here on are in columns that something moving is in
    /// Instead of `layers` where that was asked for (after Yu 2012, sec. 4.3): 12 bits of depth, 1 of facing, 19
    /// of the triangle, and the range of depths of each axis.
    std::vector<std::uint32_t> packed;
    std::vector<float> packed_low, packed_step;

    std::size_t size() const { return grids.size(); }
    /// Axis `a` by itself; only where layers are not packed and nothing moves.
    AxisView axis(std::size_t a) const;
    /// @param at  index into `offset`, of a texel
    LayerRange column(std::size_t at) const
    {
        return by_ranges() ? ranges[at] : LayerRange{offset[at], offset[at + 1]};
    }
    bool by_ranges() const { return !ranges.empty() && !without_moving; }
    /// @param k  index into `layers` or `packed`, of axis `a`
    HitLayer layer(std::size_t a, std::uint32_t k) const;
    std::size_t bytes() const
    {
        return offset.size() * sizeof(std::uint32_t) + ranges.size() * sizeof(LayerRange) +
               layers.size() * sizeof(HitLayer) + packed.size() * sizeof(std::uint32_t);
    }
};

inline constexpr std::uint32_t kPackedTriangles = 1u << 19;

/// Reuses the memory of `pool`. Throws InputError where 32-bit indices do not suffice, or 19 bits for a triangle.
void fill_pool(std::vector<HitBuffer> const& buffers, AxisPool& pool, bool packed = false);

} // namespace gi
