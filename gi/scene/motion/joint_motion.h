#pragma once
// Rotates and moves joints of an avatar together with all nodes below them.

#include "gi/scene/motion/animation.h"

namespace gi {

dvec3 joint_position(Pose const& pose, std::int32_t node);

/// Returns the orientation with x along `x` and y as close to `y` as possible. For a mirroring transform
/// (determinant < 0), returns that of the mirrored one; for a singular one, the identity.
dquat orientation_of(dvec3 x, dvec3 y, double determinant);
dquat orientation_of(dmat4 const& m);
/// Returns the orientation of a tracked body from the directions of its -Z and +Y.
dquat tracker_orientation(dvec3 forward, dvec3 up);

dmat4 turn_about(dvec3 pivot, dquat const& rotation);

/// Moves the given nodes and all nodes below them, each once.
void move_below(Scene const& scene, std::vector<std::int32_t> const& roots, dmat4 const& motion, Pose& pose);

/// Bends two bones, which start at the joints `upper` and `lower` and end at `end`, with reach() so that the end
/// goes to `target`; each bone takes the shortest rotation. `end` may be a node elsewhere (feet of rigs with
/// controls) and is moved only if it is below these joints. @return the resulting position of the end
dvec3 bend_limb(Scene const& scene, std::int32_t upper, std::int32_t lower, std::int32_t end, dvec3 target,
                dvec3 pole, Pose& pose);

} // namespace gi
