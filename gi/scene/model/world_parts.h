#pragma once
// A World together with the data needed to update it to another time.

#include "gi/scene/model/instances.h"
#include "gi/scene/shading/world_tables.h"

namespace gi {

/// A light at a node.
struct LightPlace {
    std::size_t node = 0;
    Light light;
    bool free = false; ///< placed by `light` instead of by the node
};

struct WorldParts {
    World world;
    std::vector<Instance> moving;           ///< instances that can move
    std::vector<LightPlace> light_places;   ///< all of them
    std::vector<std::uint32_t> light_place; ///< per light of the World: index into light_places
    Bounds static_bounds;
    TriangleExtent moving_extent;
    EmitterPowers static_emitters, moving_emitters;
};

WorldParts build_world_parts(std::shared_ptr<Scene const> scene, SceneTime time_s, Report& report,
                             std::optional<dvec3> origin);

/// Fills World::lights and light_place. Lights without a finite position or direction are left out and, if
/// `report` is not null, counted.
void place_lights(WorldParts& parts, Pose const& pose, Report* report);
/// Fills World::cameras in the same way.
void place_cameras(World& world, Pose const& pose, Report* report);

} // namespace gi
