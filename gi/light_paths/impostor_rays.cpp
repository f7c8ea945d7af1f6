#include "gi/light_paths/impostor_rays.h"

#include <algorithm>

namespace gi {

ImpostorRays::ImpostorRays(World const& world, Impostors const& impostors, ImpostorSettings const& settings)
    : world_(world),
      impostors_(impostors),
      settings_(settings),
      alpha_tests_(std::ranges::any_of(world.materials,
                                       [](Material const& m) { return m.alpha_mode != AlphaMode::opaque; }))
{
}

ImpostorScene ImpostorRays::scene() const
{
    return {.maps = impostors_.view(), .world = view(world_), .alpha_tests = alpha_tests_};
}

void ImpostorRays::nearest(std::span<PathQuery> queries, std::span<Hit> hits) const
{
    ImpostorScene const s = scene();
    for (std::size_t k = 0; k < queries.size(); ++k) hits[k] = gi::follow(s, queries[k], settings_).hit;
}

void ImpostorRays::follow(std::span<PathQuery const> queries, std::span<ImpostorHit> hits) const
{
    ImpostorScene const s = scene();
    for (std::size_t k = 0; k < queries.size(); ++k) hits[k] = gi::follow(s, queries[k], settings_);
}

} // namespace gi
