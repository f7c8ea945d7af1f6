#include "viewer/offline/hidden_sky.h"

#include "gi/render/exact_visibility.h"
#include "gi/scene/model/plan.h"

#include <algorithm>
#include <functional>
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

std::vector<std::string> meshes_before_sky(gi::World const& world, gi::vec3 from_m, int threads)
{
    constexpr int kDirections = 256, kMostOfThem = 230;
    constexpr std::size_t kMostMeshes = 3;
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
        if (hit.triangle == gi::kNoTriangle) continue;
        auto const next = std::ranges::upper_bound(world.placed, hit.triangle, {},
                                                   [](auto const& p) { return p.first_triangle; });
        ++met[std::prev(next)->node];
    }
    std::vector<std::pair<int, std::uint32_t>> most;
    for (auto const& [node, directions] : met) most.emplace_back(directions, node);
    std::ranges::sort(most, std::greater());
    std::vector<std::string> names;
    int hidden = 0;
    for (std::size_t k = 0; k < std::min(most.size(), kMostMeshes) && hidden < kMostOfThem; ++k) {
        hidden += most[k].first;
        names.push_back(world.scene->nodes[most[k].second].name);
    }
    return hidden >= kMostOfThem ? names : std::vector<std::string>();
}

} // namespace viewer
