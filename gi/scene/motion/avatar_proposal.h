#pragma once
// Proposes which joints of a skinned model are its head, arms and legs: by the names of usual rigs, else by the
// skeleton's tree and its shape at rest (T or A pose, upright, +Y up):
//
//   head       on the chain from where the arms branch off to the topmost joint that moves vertices:
//              the last joint that moves most of what is above the neck
//   legs       the two chains that mirror each other and end lowest; arms: the longest other two
//   limbs      of a chain, the three joints with long bones of nearly equal length between them;
//              a foot is where the leg turns level
//   left       names with a side; else by the toes, which point forward; else the model is taken to face +Z

#include "gi/scene/motion/avatar_joints.h"

namespace gi {

struct ProposedPart {
    double confidence = 0; ///< 0 to 1: how well the part fits, not a probability
    std::string reason;    ///< for people
};

struct AvatarProposal {
    AvatarJoints joints; ///< head and arms are always there; legs may be missing
    ProposedPart head, arms, legs, sides;
};

/// Throws InputError if the model has no skeleton with a head and two arms.
AvatarProposal propose_avatar_joints(Scene const& scene);

/// The proposal as a joint map (avatar_map.h) with its reasons as comments. @param model  for the first line
std::string to_avatar_map(Scene const& scene, AvatarProposal const& proposal, std::string const& model);

} // namespace gi
