#pragma once
// Many look-ups at once: the SIMD form of nearest_layer. Look-ups whose nearest column is not accepted are
// gathered and tried with the next column, also in SIMD vectors.

#include "gi/hit_buffers/axis_pool.h"

namespace gi {

/// Origins and results of look-ups in arrays of equal length.
struct QueryBatch {
    std::vector<float> x, y, z;          ///< m
    std::vector<std::uint32_t> triangle; ///< of the origin, with kAlongAxis and kWalkUp
    std::vector<float> slope;            ///< see WalkOrigin
    std::vector<std::uint32_t> axis;     ///< index in the pool; ignored if all walk along one axis
    std::vector<float> hit_x, hit_y, hit_z;
    std::vector<std::uint32_t> hit;       ///< triangle with kAlongAxis, or kNoLayerHit
    std::vector<std::uint32_t> hit_layer; ///< index into the pool's layers if there is a hit
    /// If `watched`, else empty: 1 = the look-up read a column that contains dynamic geometry, so the result
    /// might differ without it.
    std::vector<std::uint8_t> near_moving;
    bool watched = false;
    /// If `checked`, else empty: 1 = the result is doubtful, see query.h.
    std::vector<std::uint8_t> doubtful;
    bool checked = false;

    void resize(std::size_t n);
    std::size_t size() const { return x.size(); }
    void set(std::size_t i, WalkOrigin const& o, std::uint32_t along_axis);
    /// The result.
    LayerHit found(std::size_t i) const
    {
        if (hit[i] == kNoLayerHit) return {};
        return {hit[i] & kPrimitiveMask, {hit_x[i], hit_y[i], hit_z[i]}, (hit[i] & kAlongAxis) != 0};
    }
    WalkOrigin origin(std::size_t i) const
    {
        return {{x[i], y[i], z[i]},
                triangle[i] & kPrimitiveMask,
                (triangle[i] & kAlongAxis) != 0,
                (triangle[i] & kWalkUp) != 0,
                slope[i]};
    }
};

/// Every look-up along its own axis.
void nearest_layers(AxisPool const& pool, View<Surface const> surfaces, QueryBatch& batch);
/// All look-ups along axis `a`.
void nearest_layers(AxisPool const& pool, std::size_t a, View<Surface const> surfaces, QueryBatch& batch);

} // namespace gi
