#pragma once
// The project's own BVH (gi/bvh) of a world in a memory space: one tree of the static triangles and one of those
// that may move, which is refitted; and exact rays through both in kernels, one at a time.

#include "gi/bvh/traverse.h"
#include "gi/render/panes.h"

#include <algorithm>

namespace gi {

/// Exact rays of kernels. The trees lie in the space that runs the kernel.
struct KernelRays {
    BvhView trees[2];         ///< static, dynamic; either may be empty
    bool alpha_tests = false; ///< some surfaces are partly transparent

    /// As ExactVisibility::nearest.
    GI_FN Hit nearest(WorldView const& world, RayQuery const& q) const
    {
        BvhHit const hit = trace<false>(
            q, [&](std::uint32_t triangle, vec2 weights) { return meets(world, q, triangle, weights); });
        return hit.triangle == kNoBvhTriangle ? Hit{} : Hit{hit.triangle, hit.weights, hit.distance};
    }
    /// As ExactVisibility::occluded.
    GI_FN bool occluded(WorldView const& world, RayQuery const& q) const
    {
        return trace<true>(q, [&](std::uint32_t triangle, vec2 weights) {
                   return meets(world, q, triangle, weights);
               }).triangle != kNoBvhTriangle;
    }
    /// As ExactVisibility::transmittance. @tparam panes  there are some: kernels without are smaller
    template <bool panes>
    GI_FN vec3 transmittance(WorldView const& world, RayQuery const& q) const
    {
        if (!panes || q.to_lamp == 0) return vec3{occluded(world, q) ? 0.0f : 1.0f};
        PaneCrossings crossings;
        BvhHit const hit = trace<true>(q, [&](std::uint32_t triangle, vec2 weights) {
            if (!meets(world, q, triangle, weights)) return false;
            if (!is_pane(world.materials[world.surfaces[triangle].material])) return true;
            crossings.pass(world, q, triangle, weights);
            return false;
        });
        return hit.triangle == kNoBvhTriangle ? crossings.left : vec3{0};
    }

private:
    GI_FN bool meets(WorldView const& world, RayQuery const& q, std::uint32_t triangle, vec2 weights) const
    {
        return !alpha_tests || covers(world, triangle, weights, q.seed);
    }
    /// @param accepts  see meet_leaf
    template <bool any, class Accepts>
    GI_FN BvhHit trace(RayQuery const& q, Accepts const& accepts) const
    {
        BvhRay const ray(q.ray, q.start);
        BvhHit hit;
        hit.distance = q.reach;
        // One traversal in the code; trees are not indexed, as a device would copy them to local memory.
#pragma unroll 1
        for (int k = 0; k < 2; ++k) {
            BvhView const tree = k == 0 ? trees[0] : trees[1];
            if (!any || hit.triangle == kNoBvhTriangle) trace_scalar<any>(tree, ray, hit, accepts);
        }
        return hit;
    }
};

template <Space S>
class WorldBvh {
public:
    /// @param world  its arrays lie in space S
    /// @param alpha_tests, first_moving, stop  as for ExactVisibility
    WorldBvh(WorldView const& world, bool alpha_tests, std::size_t first_moving, StopRequest const* stop = nullptr)
        : alpha_tests_(alpha_tests)
    {
        auto const triangles = std::uint32_t(world.triangles.size());
        first_[1] = std::uint32_t(std::min<std::size_t>(first_moving, triangles));
        first_[2] = triangles;
        for (int k = 0; k < 2; ++k) trees_[k] = build_bvh<S>(list(world, k), stop);
    }
    void test_alpha(bool alpha_tests) { alpha_tests_ = alpha_tests; }
    /// Refits the dynamic tree.
    void moved(WorldView const& world) { refit(trees_[1], list(world, 1)); }

    KernelRays rays() const { return {{trees_[0].view(), trees_[1].view()}, alpha_tests_}; }
    Bvh<S> const& still() const { return trees_[0]; }
    Bvh<S> const& moving() const { return trees_[1]; }
    bool alpha_tests() const { return alpha_tests_; }

private:
    TriangleList list(WorldView const& world, int tree) const
    {
        return {world.positions, world.triangles, first_[tree], first_[tree + 1]};
    }

    std::uint32_t first_[3] = {}; ///< triangles of the trees: of the first, of the second, end
    Bvh<S> trees_[2];             ///< static, dynamic
    bool alpha_tests_;
};

} // namespace gi
