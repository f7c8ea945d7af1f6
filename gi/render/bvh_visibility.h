#pragma once
// Exact rays against a World through the project's own BVH (gi/bvh) on the CPU, in the form of ExactVisibility,
// for which it is a peer with the same answers; single rays. What kernels use is in world_bvh.h.

#include "gi/render/world_bvh.h"

#include <span>

namespace gi {

class BvhVisibility {
public:
    /// @param alpha_tests, first_moving, stop  as for ExactVisibility; `world` must outlive this object
    BvhVisibility(World const& world, bool alpha_tests, std::size_t first_moving = ~std::size_t(0),
                  StopRequest const* stop = nullptr)
        : world_(view(world)), bvh_(world_, alpha_tests, first_moving, stop)
    {
    }
    /// Refits the dynamic tree. Materials must not have changed.
    void moved(World const& world)
    {
        world_ = view(world);
        bvh_.moved(world_);
    }

    /// As ExactVisibility.
    void nearest(std::span<RayQuery const> queries, std::span<Hit> hits, RayWorld met = RayWorld::all) const;
    void occluded(std::span<RayQuery const> queries, std::span<std::uint8_t> blocked,
                  RayWorld met = RayWorld::all) const;

    HostBvh const& still() const { return bvh_.still(); }
    HostBvh const& moving() const { return bvh_.moving(); }

private:
    template <bool any, class Use>
    void trace(std::span<RayQuery const> queries, RayWorld met, Use const& use) const;

    WorldView world_;
    WorldBvh<Space::host> bvh_;
};

} // namespace gi
