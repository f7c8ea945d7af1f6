#pragma once
// What of a scene can move and why: the world keeps that apart from what cannot (world.h).

#include "gi/scene/model/scene.h"

#include <string>
#include <vector>

namespace gi {

/// Reasons are empty where nothing moves.
struct Motion {
    std::vector<std::string> node;  ///< per node: "clip 'walk'", "driven", also where only an ancestor moves
    std::vector<std::string> morph; ///< per node: what changes its morph weights
};

/// A node moves where it or an ancestor is driven, or a channel of a clip that plays gives it values that change
/// in time.
Motion find_motion(Scene const& scene);

/// Why one mesh at a node can move; empty = it cannot. A skinned mesh moves with the joints of its skin.
std::string why_moving(Scene const& scene, Motion const& motion, std::size_t node, Mesh const& mesh);

/// All reasons of the scene's instances, each once, in order.
std::vector<std::string> reasons_for_motion(Scene const& scene);

} // namespace gi
