#pragma once
// A World and what it was made of, so that it can be taken to another moment.

#include "gi/scene/model/instances.h"
#include "gi/scene/shading/world_tables.h"

namespace gi {

/// A light at a node.
struct LightPlace {
    std::size_t node = 0;
    Light light;
    bool free = false; ///< `light` says where it is, not the node
};

struct WorldParts {
    World world;
    std::vector<Instance> moving;           ///< instances that can move
    std::vector<LightPlace> light_places;   ///< all of them
    std::vector<std::uint32_t> light_place; ///< per light of the World
    Bounds static_bounds;
    TriangleExtent moving_extent;
    EmitterPowers static_emitters, moving_emitters;
};

WorldParts build_world_parts(std::shared_ptr<Scene const> scene, SceneTime time_s, Report& report,
                             std::optional<dvec3> origin);

/// Fill World::lights and light_place; lights at no finite place are left out and, where there is a report,
/// counted.
void place_lights(WorldParts& parts, Pose const& pose, Report* report);
/// Fill World::cameras, as above.
void place_cameras(World& world, Pose const& pose, Report* report);

} // namespace gi
