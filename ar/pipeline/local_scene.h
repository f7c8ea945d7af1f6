#pragma once
// Joins nearby real objects and the virtual objects in one scene. Virtual objects are its movable part, so that
// they can be removed while everything else stays unchanged.

#include "gi/render/frame_renderer.h"
#include "gi/scene/model/scene.h"
#include "gi/scene/motion/animation.h"

#include <memory>

namespace ar {

struct LocalScene {
    std::shared_ptr<gi::Scene const> scene;
    std::size_t first_virtual_node = 0;  ///< index of the first virtual node; all later ones are virtual
    std::size_t first_virtual_light = 0; ///< index in World::lights
};

/// Removes cameras, environment and background.
void leave_out_views(gi::Scene& scene);

/// Cameras and environments of both are left out: the place is lit by the captured light and by lights of the
/// real scene. Virtual lights illuminate real objects.
/// @throws InputError if part of the real scene moves: it could not be distinguished from the virtual objects
LocalScene join_scenes(gi::Scene real, gi::Scene virtual_things, gi::dmat4 const& world_from_virtual);

/// Pose of all nodes at a time; for the side without virtual objects, these are scaled to zero.
gi::Pose local_pose(LocalScene const& local, gi::SceneTime time_s, gi::PairSide side);

} // namespace ar
