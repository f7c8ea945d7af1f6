#pragma once
// Edits of a scene while the viewer runs, by key:
//   object.NODE.position [x, y, z]     m, world
//   object.NODE.rotation [x, y, z, w]
//   object.NODE.scale s
//   light.N.intensity [r, g, b]
//   light.N.position [x, y, z]
//   material.NAME.base_color [r, g, b]
//   material.NAME.roughness 0..1
//   material.NAME.metallic 0..1
//   material.NAME.emission [r, g, b]
//   environment.rotation radians
//   environment.scale s
//
// NODE and NAME are names or numbers. When an object is moved for the first time, the world is rebuilt, because
// static and dynamic geometry are kept apart.

#include "gi/scene/motion/moving_world.h"
#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Pose of an object that the user placed; it replaces the pose from its node and animation clips.
struct PlacedObject {
    std::size_t node = 0;
    gi::dvec3 position{0}; ///< m, world
    gi::dquat rotation{1, 0, 0, 0};
    double scale = 1;
};

bool is_scene_edit(std::string const& key);

/// Applies an edit of an object: starts from its entry in `placed`, or else from its node's pose in `now`.
/// @param now  pose of the scene   Throws InputError if there is no such object or the value is invalid.
PlacedObject placed_object(gi::Scene const& scene, gi::Pose const& now, std::vector<PlacedObject> const& placed,
                           Change const& change);
/// Writes the placed nodes and their descendants into `pose`.
void place(gi::Scene const& scene, std::vector<PlacedObject> const& placed, gi::Pose& pose);

bool is_object_edit(std::string const& key);
/// Applies an edit of a light, a material or the environment. Throws InputError.
gi::Changes edit(gi::MovingWorld& world, Change const& change);

} // namespace viewer
