#pragma once
// Light paths by distance impostors instead of exact rays.

#include "gi/light_paths/impostor_walk.h"
#include "gi/light_paths/impostors.h"
#include "gi/light_paths/path_rays.h"

#include <algorithm>

namespace gi {

class ImpostorRays : public PathRays {
public:
    /// @param world, impostors  must outlive it
    ImpostorRays(World const& world, Impostors const& impostors, ImpostorSettings const& settings = {})
        : world_(world),
          impostors_(impostors),
          settings_(settings),
          alpha_tests_(std::ranges::any_of(world.materials,
                                           [](Material const& m) { return m.alpha_mode != AlphaMode::opaque; }))
    {
    }

    void nearest(std::span<PathQuery> queries, std::span<Hit> hits) const override
    {
        ImpostorScene const s = scene();
        for (std::size_t k = 0; k < queries.size(); ++k) hits[k] = follow(s, queries[k], settings_).hit;
    }
    ImpostorScene scene() const
    {
        return {.maps = impostors_.view(), .world = view(world_), .alpha_tests = alpha_tests_};
    }

private:
    World const& world_;
    Impostors const& impostors_;
    ImpostorSettings settings_;
    bool alpha_tests_;
};

} // namespace gi
