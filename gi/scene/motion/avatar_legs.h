#pragma once
// Legs of an avatar: from where its foot shall be to hip, knee and ankle.

#include "gi/scene/motion/avatar.h"

namespace gi {

/// No leg (all -1) where the joints are none, bones have no length, or the ankle is not below the hip.
/// @param avatar  of which world_from_body and floor_y are known
Avatar::Leg make_leg(Scene const& scene, Pose const& rest, LegJoints const& joints, Avatar const& avatar);

/// Bends the leg so that the ankle is at its target and the foot turned as that, by reach(): for a foot below the
/// hip the knee goes forward, between the way the body faces and the way the toes point, and that direction is
/// carried along to other places, so that it is undecided only for a foot above the hip. A target out of reach:
/// the heel rises, by up to 0.9 rad, about the ball of the foot, which stays; what is still out of reach leaves
/// the floor, the leg straight. @param target  rigid, finite  @param body  world from body
void drive_leg(Scene const& scene, Avatar::Leg const& leg, dmat4 const& target, dquat const& body, Pose& pose);

} // namespace gi
