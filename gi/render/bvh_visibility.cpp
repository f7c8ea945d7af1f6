#include "gi/render/bvh_visibility.h"

#include "gi/bvh/traverse_lanes.h"
#include "gi/render/coverage_test.h"

#include <algorithm>

namespace gi {

TriangleList BvhVisibility::list(World const& world, int tree) const
{
    return {world.positions, world.triangles, first_[tree], first_[tree + 1]};
}

BvhVisibility::BvhVisibility(World const& world, bool alpha_tests, std::size_t first_moving,
                             StopRequest const* stop)
    : world_(view(world)), alpha_tests_(alpha_tests)
{
    auto const triangles = std::uint32_t(world.triangles.size());
    first_[0] = 0;
    first_[1] = std::uint32_t(std::min<std::size_t>(first_moving, triangles));
    first_[2] = triangles;
    for (int k = 0; k < 2; ++k) trees_[k] = build_bvh<Space::host>(list(world, k), stop);
}

void BvhVisibility::moved(World const& world)
{
    world_ = view(world);
    refit(trees_[1], list(world, 1));
}

template <bool any, class Use>
void BvhVisibility::trace(std::span<RayQuery const> queries, RayWorld met, Use const& use) const
{
    int const trees = met == RayWorld::what_stays || first_[1] == first_[2] ? 1 : 2;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        RayQuery const& q = queries[i];
        BvhRay const ray(q.ray, q.start);
        BvhHit hit;
        hit.distance = q.reach;
        auto const accepts = [&](std::uint32_t triangle, vec2 weights) {
            return !alpha_tests_ || covers(world_, triangle, weights, q.seed);
        };
        for (int k = 0; k < trees && !(any && hit.triangle != kNoBvhTriangle); ++k)
            trace_lanes<any>(trees_[k].view(), ray, hit, accepts);
        use(i, hit);
    }
}

void BvhVisibility::nearest(std::span<RayQuery const> queries, std::span<Hit> hits, RayWorld met) const
{
    trace<false>(queries, met, [&](std::size_t i, BvhHit const& hit) {
        hits[i] = hit.triangle == kNoBvhTriangle ? Hit{} : Hit{hit.triangle, hit.weights, hit.distance};
    });
}

void BvhVisibility::occluded(std::span<RayQuery const> queries, std::span<std::uint8_t> blocked,
                             RayWorld met) const
{
    trace<true>(queries, met,
                [&](std::size_t i, BvhHit const& hit) { blocked[i] = hit.triangle != kNoBvhTriangle; });
}

} // namespace gi
