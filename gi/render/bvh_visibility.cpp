#include "gi/render/bvh_visibility.h"

#include "gi/bvh/traverse_lanes.h"

namespace gi {

template <bool any, class Use>
void BvhVisibility::trace(std::span<RayQuery const> queries, RayWorld met, Use const& use) const
{
    HostBvh const* const trees[] = {&bvh_.still(), &bvh_.moving()};
    int const count = met == RayWorld::what_stays || bvh_.moving().nodes.size() == 0 ? 1 : 2;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        RayQuery const& q = queries[i];
        BvhRay const ray(q.ray, q.start);
        BvhHit hit;
        hit.distance = q.reach;
        auto const accepts = [&](std::uint32_t triangle, vec2 weights) {
            return !bvh_.alpha_tests() || covers(world_, triangle, weights, q.seed);
        };
        for (int k = 0; k < count && !(any && hit.triangle != kNoBvhTriangle); ++k)
            trace_lanes<any>(trees[k]->view(), ray, hit, accepts);
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
