#pragma once
// Edits of a scene while the viewer runs, by key: object.NODE.position [x, y, z], light.N.intensity 5. The table
// scene_edit_keys() has them all, with their ranges and meanings.
//
// NODE and NAME are names or numbers, N a number from 0 or `all`. Colours are linear; one number stands for three
// equal ones. When an object is moved for the first time, the world is rebuilt, because static and dynamic
// geometry are kept apart.

#include "gi/scene/motion/moving_world.h"
#include "viewer/protocol/frame_command.h"

#include <span>
#include <string_view>

namespace viewer {

/// Pose of an object that the user placed; it replaces the pose from its node and animation clips.
struct PlacedObject {
    std::size_t node = 0;
    gi::dvec3 position{0}; ///< m, world
    gi::dquat rotation{1, 0, 0, 0};
    double scale = 1;
};

/// One kind of edit: KIND.NAME.PROPERTY, without NAME for the environment.
struct SceneEditKey {
    std::string_view kind, what; ///< "light", "intensity"
    std::string_view name;       ///< placeholder for the name in texts: "N"; empty = there is one only
    int count;                   ///< of its numbers
    bool or_one;                 ///< one number stands for all of them
    double low, high;            ///< of each number
    std::string_view meaning;    ///< with the unit
};
std::span<SceneEditKey const> scene_edit_keys();
/// "light.N.intensity"
std::string pattern_of(SceneEditKey const& key);

bool is_scene_edit(std::string const& key);
/// The kind of edit. Throws InputError, with the nearest property, if there is none of this key.
SceneEditKey const& find_scene_edit(std::string const& key);
/// Throws InputError unless the key is that of an edit and the value fits it. Whether the scene has the object,
/// light or material is not known here.
void check_scene_edit(Change const& change);

/// Applies an edit of an object: starts from its entry in `placed`, or else from its node's pose in `now`.
/// @param now  pose of the scene   Throws InputError if there is no such object or the value is invalid.
PlacedObject placed_object(gi::Scene const& scene, gi::Pose const& now, std::vector<PlacedObject> const& placed,
                           Change const& change);
/// Writes the placed nodes and their descendants into `pose`.
void place(gi::Scene const& scene, std::vector<PlacedObject> const& placed, gi::Pose& pose);

bool is_object_edit(std::string const& key);
bool is_light_edit(std::string const& key);
/// Applies an edit of a light, a material or the environment. Throws InputError.
gi::Changes edit(gi::MovingWorld& world, Change const& change);
/// Applies an edit of lights to those of a world. Throws InputError.
/// @param authored  their intensities in the scene  @param origin  of the world
void edit_lights(std::vector<gi::Light>& lights, Change const& change, std::span<gi::vec3 const> authored,
                 gi::dvec3 origin);

} // namespace viewer
