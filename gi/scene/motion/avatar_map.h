#pragma once
// Joint maps: YAML files that say which nodes of a skinned model are its head, arms and legs.
//
//   head: Bone_12
//   left_arm: {upper: Bone_7, lower: Bone_8, hand: Bone_9}    # the avatar's own left
//   right_arm: {upper: "#21", lower: "#22", hand: "#23"}      # nodes by number
//   left_leg: {upper: Thigh_L, lower: Shin_L, foot: Foot_L}   # both legs or none
//   right_leg: {upper: Thigh_R, lower: Shin_R, foot: Foot_R}
//
// What is left out is searched for by name (avatar_joints.h). Numbers count the nodes of the loaded model from 0,
// as `lightwell avatar map` writes them.

#include "gi/scene/motion/avatar_joints.h"

#include <filesystem>

namespace gi {

/// The joints of this model by a map. @param file  for messages
/// Throws InputError with file:line:column: not YAML, unknown keys, nodes that do not exist or share their name,
/// one node twice, limbs that are no chains.
AvatarJoints parse_avatar_map(std::string const& text, std::string const& file, Scene const& scene);
AvatarJoints read_avatar_map(std::filesystem::path const& file, Scene const& scene);

/// How a map names a node: by its name if no other has it, else by "#" and its number.
std::string node_reference(Scene const& scene, std::int32_t node);

} // namespace gi
