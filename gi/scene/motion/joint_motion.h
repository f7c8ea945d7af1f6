#pragma once
// Joints of an avatar, turned and moved with all that hangs on them.

#include "gi/scene/motion/animation.h"

namespace gi {

dvec3 joint_position(Pose const& pose, std::int32_t node);

/// x along `x`, y as far towards `y` as can be. Of a transform that mirrors (determinant < 0), the mirrored one's;
/// none of one that is flat.
dquat orientation_of(dvec3 x, dvec3 y, double determinant);
dquat orientation_of(dmat4 const& m);
/// Of a tracked body, from the directions of its -Z and +Y.
dquat tracker_orientation(dvec3 forward, dvec3 up);

dmat4 turn_about(dvec3 pivot, dquat const& rotation);

/// Moves the nodes and all below them, each once.
void move_below(Scene const& scene, std::vector<std::int32_t> const& roots, dmat4 const& motion, Pose& pose);

/// Two bones that begin at the joints `upper` and `lower` and end at `end`, which may be a node elsewhere (feet of
/// rigs with controls): it is not moved unless it is below them. Bent by reach() so that the end goes to `target`,
/// each bone by its shortest turn. @return where the end comes to lie
dvec3 bend_limb(Scene const& scene, std::int32_t upper, std::int32_t lower, std::int32_t end, dvec3 target,
                dvec3 pole, Pose& pose);

} // namespace gi
