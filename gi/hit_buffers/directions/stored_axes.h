#pragma once
// Hit buffers along a fixed set of directions, and which of these is nearest to a given one.

#include "gi/hit_buffers/directions/axis_set.h"
#include "gi/hit_buffers/directions/direction_map.h"
#include "gi/hit_buffers/settings.h"
#include "gi/raster/triangle_soup.h"
#include "gi/render/render_settings.h"

#include <memory>

namespace gi {

/// The settings with a default set and resolution where nothing is chosen.
SlhbSettings with_stored_axes(SlhbSettings settings);

class StoredAxes {
public:
    /// A direction of the set; index 2 k is along axis k, 2 k + 1 against it.
    struct Direction {
        vec3 along;  ///< unit
        float texel; ///< texel size of its buffer, m
    };
    /// Builds the hit buffers: SlhbSettings::directions, resolution, most_layers. Throws InputError on unknown
    /// directions, Interrupted. @param world  must outlive it
    StoredAxes(World const& world, SlhbSettings const& settings, std::uint64_t seed, std::size_t first_moving,
               StopRequest const* stop = nullptr);

    /// Follows triangles that have moved.
    void moved();
    /// Index of the nearest direction.
    std::uint32_t nearest(vec3 direction) const { return view(nearest_).look_up(direction); }
    Direction const& direction(std::uint32_t index) const { return directions_[index]; }
    AxisPool const& pool() const { return axes_->pool(); }
    std::uint64_t lost() const { return axes_->lost(); } ///< layers beyond the limit of a texel

private:
    void build(Bounds const& bounds);

    World const& world_;
    SlhbSettings settings_;
    std::uint64_t seed_;
    std::size_t first_moving_;
    StopRequest const* stop_;
    TriangleSoup soup_;
    CutOuts cut_outs_;
    Bounds bounds_; ///< of the grids
    std::unique_ptr<AxisSet> axes_;
    std::vector<Direction> directions_;
    DirectionMap nearest_;
};

/// Tangent of the angle between an axis and a normal with this cosine, bounded.
inline float slope_of(float cosine)
{
    return std::sqrt(std::max(0.0f, 1 - square(cosine))) / std::max(cosine, 1e-3f);
}

} // namespace gi
