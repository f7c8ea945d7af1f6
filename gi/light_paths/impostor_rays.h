#pragma once
// Light paths by distance impostors instead of exact rays.

#include "gi/light_paths/impostor_walk.h"
#include "gi/light_paths/impostors.h"
#include "gi/light_paths/path_rays.h"

namespace gi {

class ImpostorRays : public PathRays {
public:
    /// @param world, impostors  must outlive it
    ImpostorRays(World const& world, Impostors const& impostors, ImpostorSettings const& settings = {});

    void nearest(std::span<PathQuery> queries, std::span<Hit> hits) const override;
    /// The same, and how it was found.
    void follow(std::span<PathQuery const> queries, std::span<ImpostorHit> hits) const;

private:
    ImpostorScene scene() const;

    World const& world_;
    Impostors const& impostors_;
    ImpostorSettings settings_;
    bool alpha_tests_;
};

} // namespace gi
