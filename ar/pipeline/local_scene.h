#pragma once
// The real things near the virtual ones, and the virtual ones, as one scene: virtual things are what moves in it,
// so that they can be taken away while all else stays as it was.

#include "gi/render/frame_renderer.h"
#include "gi/scene/model/scene.h"
#include "gi/scene/motion/animation.h"

#include <memory>

namespace viewer {

struct LocalScene {
    std::shared_ptr<gi::Scene const> scene;
    std::size_t first_virtual_node = 0;  ///< and all after it
    std::size_t first_virtual_light = 0; ///< of World::lights
};

/// Cameras, environment and background.
void leave_out_views(gi::Scene& scene);

/// Cameras and environments of both are left out: the place is lit by what was captured there, and by lamps of the
/// real scene. Virtual lamps light real things.
/// @throws InputError something of the real scene moves: it could not be told from the virtual
LocalScene join_scenes(gi::Scene real, gi::Scene virtual_things, gi::dmat4 const& world_from_virtual);

/// All nodes at a time; without the virtual things, these have no size.
gi::Pose local_pose(LocalScene const& local, gi::SceneTime time_s, gi::PairSide side);

} // namespace viewer
