#pragma once
// What can be changed in a scene while the viewer runs, by key:
//   object.NODE.position [x, y, z]  m, world      light.N.intensity [r, g, b]     material.NAME.base_color [r, g,
//   b] object.NODE.rotation [x, y, z, w]             light.N.position [x, y, z]      material.NAME.roughness 0..1
//   object.NODE.scale s                           environment.rotation radians    material.NAME.metallic 0..1
//                                                 environment.scale s             material.NAME.emission [r, g, b]
// NODE and NAME are names or numbers. An object that is moved for the first time has to be told from what stays:
// then the world is built anew.

#include "gi/scene/motion/moving_world.h"
#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Where an object was put: in place of what its clips and its node say.
struct PlacedObject {
    std::size_t node = 0;
    gi::dvec3 position{0}; ///< m, world
    gi::dquat rotation{1, 0, 0, 0};
    double scale = 1;
};

bool is_scene_edit(std::string const& key);

/// A key of an object: the same as it was put before, or as its node is now, with the change.
/// @param now  pose of the scene   Throws InputError where there is no such object, or the value is not right.
PlacedObject placed_object(gi::Scene const& scene, gi::Pose const& now, std::vector<PlacedObject> const& placed,
                           Change const& change);
/// Nodes and all that hang on them, where they were put.
void place(gi::Scene const& scene, std::vector<PlacedObject> const& placed, gi::Pose& pose);

bool is_object_edit(std::string const& key);
/// Of lights, materials, the environment. Throws InputError.
gi::Changes edit(gi::MovingWorld& world, Change const& change);

} // namespace viewer
