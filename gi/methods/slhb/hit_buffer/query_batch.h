#pragma once
// Many queries at once: the vector form of nearest_layer. Queries whose nearest column does not speak for their
// origin are gathered and asked again, in vectors too.

#include "gi/methods/slhb/hit_buffer/axis_pool.h"

namespace gi {

/// Origins and answers of queries in arrays of equal length.
struct QueryBatch {
    std::vector<float> x, y, z;          ///< m
    std::vector<std::uint32_t> triangle; ///< of the origin, with kAlongAxis and kWalkUp
    std::vector<float> slope;            ///< see WalkOrigin
    std::vector<std::uint32_t> axis;     ///< of the pool; not read where all walk along one axis
    std::vector<float> hit_x, hit_y, hit_z;
    std::vector<std::uint32_t> hit;       ///< triangle with kAlongAxis, or kNoLayerHit
    std::vector<std::uint32_t> hit_layer; ///< index into the pool's layers where there is a hit
    /// Where `watched`, else empty: 1 = a column was asked that something moving is in, so that the answer might
    /// be another one without it.
    std::vector<std::uint8_t> near_moving;
    bool watched = false;

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
