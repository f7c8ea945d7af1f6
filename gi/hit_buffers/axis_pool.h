#pragma once
// The hit buffers of several axes, stored together.

#include "gi/core/progress.h"
#include "gi/hit_buffers/query.h"

namespace gi {

/// Layers of one texel, as indices relative to the axis' first layer.
struct LayerRange {
    std::uint32_t begin, end;
};

/// The buffers of several axes in shared arrays, so that one SIMD vector can walk along many axes.
struct AxisPool {
    std::vector<RasterGrid> grids;
    std::vector<std::uint32_t> first_offset, first_layer; ///< per axis
    std::vector<std::uint32_t> offset; ///< texels + 1 entries per axis, relative to the axis' first layer
    std::vector<HitLayer> layers;      ///< of all axes, followed by those of moving_layers.h
    /// With dynamic geometry, replaces `offset` (same indices): the columns, which may be stored anywhere.
    std::vector<LayerRange> ranges;
    bool without_moving = false;     ///< ignore `ranges`: use the columns without dynamic geometry
    std::uint32_t first_moved = ~0u; ///< layers from here on belong to columns that contain dynamic geometry
    /// Used instead of `layers` with packing (after Yu 2012, sec. 4.3): 12 bits of depth, 1 of facing, 19 of the
    /// triangle; plus the range of depths of each axis.
    std::vector<std::uint32_t> packed;
    std::vector<float> packed_low, packed_step;

    std::size_t size() const { return grids.size(); }
    /// Returns a view of axis `a`; only for unpacked layers without dynamic geometry.
    AxisView axis(std::size_t a) const;
    /// @param at  index of a texel in `offset`
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

/// Fills the pool, reusing its memory. Throws InputError if 32-bit indices, or 19 bits for a packed triangle, are
/// not enough, and Interrupted where `stop` is given up.
void fill_pool(std::vector<HitBuffer> const& buffers, AxisPool& pool, bool packed = false,
               BuildStop const& stop = BuildStop(nullptr));

} // namespace gi
