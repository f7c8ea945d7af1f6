#pragma once
// Many queries at once: the vector form of nearest_layer. Queries whose nearest column does not speak for their
// origin are gathered and asked again, in vectors too.

#include "gi/slhb/query.h"

namespace gi {

/// The buffers of several axes in three arrays, so that one vector can walk along many axes.
struct AxisPool {
    std::vector<RasterGrid> grids;
    std::vector<std::uint32_t> first_offset, first_layer; ///< of each axis
    std::vector<std::uint32_t> offset; ///< per axis texels + 1 entries, from the axis' first layer on
    std::vector<HitLayer> layers;
    /// Instead of `layers` where that was asked for (after Yu 2012, sec. 4.3): 12 bits of depth, 1 of facing, 19
    /// of the triangle, and the range of depths of each axis.
    std::vector<std::uint32_t> packed;
    std::vector<float> packed_low, packed_step;

    std::size_t size() const { return grids.size(); }
    /// Axis `a` by itself; only where layers are not packed.
    AxisView axis(std::size_t a) const;
    std::size_t bytes() const
    {
        return offset.size() * sizeof(std::uint32_t) + layers.size() * sizeof(HitLayer) +
               packed.size() * sizeof(std::uint32_t);
    }
};

inline constexpr std::uint32_t kPackedTriangles = 1u << 19;

/// Reuses the memory of `pool`. Throws InputError where 32-bit indices do not suffice, or 19 bits for a triangle.
void fill_pool(std::vector<HitBuffer> const& buffers, AxisPool& pool, bool packed = false);

/// Origins and answers of queries in arrays of equal length.
struct QueryBatch {
    std::vector<float> x, y, z;          ///< m
    std::vector<std::uint32_t> triangle; ///< of the origin, with kAlongAxis and kWalkUp
    std::vector<float> slope;            ///< see WalkOrigin
    std::vector<std::uint32_t> axis;     ///< of the pool; not read where all walk along one axis
    std::vector<float> hit_x, hit_y, hit_z;
    std::vector<std::uint32_t> hit;       ///< triangle with kAlongAxis, or kNoLayerHit
    std::vector<std::uint32_t> hit_layer; ///< index into the pool's layers where there is a hit

    void resize(std::size_t n);
    std::size_t size() const { return x.size(); }
    void set(std::size_t i, WalkOrigin const& o, std::uint32_t along_axis);
    WalkOrigin origin(std::size_t i) const
    {
        return {{x[i], y[i], z[i]},
                triangle[i] & kPrimitiveMask,
                (triangle[i] & kAlongAxis) != 0,
                (triangle[i] & kWalkUp) != 0,
                slope[i]};
    }
};

/// Every query along its own axis.
void nearest_layers(AxisPool const& pool, View<Surface const> surfaces, QueryBatch& batch);
/// All along axis `a`.
void nearest_layers(AxisPool const& pool, std::size_t a, View<Surface const> surfaces, QueryBatch& batch);

} // namespace gi
