#pragma once
// Determines which parts of a scene can move and why; the world stores them
// separately from static parts (world.h).

#include "gi/scene/model/scene.h"

#include <string>
#include <vector>

namespace gi {

/// Reasons why nodes move; empty = does not move.
struct Motion {
    std::vector<std::string> node;  ///< per node: "clip 'walk'", "driven", also if only an ancestor moves
    std::vector<std::string> morph; ///< per node: reason why its morph weights change
};

/// A node moves if it or an ancestor is driven, or if a channel of a playing clip
/// gives it values that change over time.
Motion find_motion(Scene const& scene);

/// Returns why a mesh at a node can move; empty = it cannot. A skinned mesh moves with the joints of its skin.
std::string why_moving(Scene const& scene, Motion const& motion, std::size_t node, Mesh const& mesh);

/// Returns the distinct reasons of the scene's instances, in order.
std::vector<std::string> reasons_for_motion(Scene const& scene);

} // namespace gi
