#pragma once
// Exact rays against a World through the project's own BVH (gi/bvh): the static triangles have one tree, the
// dynamic ones another, which is refitted when they move. Same answers as ExactVisibility, for which it is a peer
// on the CPU and the counterpart on a GPU; single rays.

#include "gi/bvh/bvh.h"
#include "gi/render/exact_visibility.h"

namespace gi {

class BvhVisibility {
public:
    /// @param alpha_tests, first_moving, stop  as for ExactVisibility; `world` must outlive this object
    BvhVisibility(World const& world, bool alpha_tests, std::size_t first_moving = ~std::size_t(0),
                  StopRequest const* stop = nullptr);
    /// Refits the dynamic tree. Materials must not have changed.
    void moved(World const& world);

    /// As ExactVisibility.
    void nearest(std::span<RayQuery const> queries, std::span<Hit> hits, RayWorld met = RayWorld::all) const;
    void occluded(std::span<RayQuery const> queries, std::span<std::uint8_t> blocked,
                  RayWorld met = RayWorld::all) const;

    HostBvh const& still() const { return trees_[0]; }
    HostBvh const& moving() const { return trees_[1]; }

private:
    template <bool any, class Use>
    void trace(std::span<RayQuery const> queries, RayWorld met, Use const& use) const;
    TriangleList list(World const& world, int tree) const;

    std::uint32_t first_[3]; ///< triangles of the trees: of the first, of the second, end
    HostBvh trees_[2];       ///< static, dynamic
    WorldView world_;
    bool alpha_tests_;
};

} // namespace gi
