#include "viewer/offline/hidden_sky.h"

#include "gi/render/exact_visibility.h"
#include "gi/scene/model/plan.h"

#include <algorithm>
#include <map>

namespace viewer {
namespace {

/// Evenly spread over the sphere (Fibonacci's spiral).
gi::vec3 direction(int k, int n)
{
    float const z = 1 - (2 * float(k) + 1) / float(n), r = std::sqrt(1 - z * z), turn = 2.3999632f * float(k);
    return {r * std::cos(turn), z, r * std::sin(turn)};
}

} // namespace

std::string mesh_before_sky(gi::World const& world, gi::vec3 from_m, int threads)
{
    constexpr int kDirections = 256, kMostOfThem = 230;
    if (world.triangles.empty()) return {};
    gi::ExactVisibility const visibility(world, gi::plan_scene(world).alpha_tests, threads);
    // From outside, so that what they meet first is what lies before the sky.
    float const far_m = 2 * (world.bounds.radius() + glm::length(from_m - world.bounds.center()));
    std::vector<gi::RayQuery> rays;
    for (int k = 0; k < kDirections; ++k) {
        gi::vec3 const out = direction(k, kDirections);
        rays.push_back({.ray = {from_m + far_m * out, -out}, .reach = far_m});
    }
    std::vector<gi::Hit> hits(rays.size());
    visibility.nearest(rays, hits);
    std::map<std::uint32_t, int> met; // directions, by node
    for (gi::Hit const& hit : hits) {
        if (hit.triangle == gi::kNoTriangle) return {};
        auto const next = std::ranges::upper_bound(world.placed, hit.triangle, {},
                                                   [](auto const& p) { return p.first_triangle; });
        ++met[std::prev(next)->node];
    }
    auto const most = std::ranges::max_element(met, {}, [](auto const& m) { return m.second; });
    return most->second >= kMostOfThem ? world.scene->nodes[most->first].name : "";
}

} // namespace viewer
