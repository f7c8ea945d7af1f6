#pragma once
// Legs of an avatar: hip, knee and ankle rotations from a target for the foot.

#include "gi/scene/motion/avatar.h"

namespace gi {

/// Returns no leg (all -1) if there are no joints, a bone has no length, or the ankle is not below the hip.
/// @param avatar  its world_from_body and floor_y must be set
Avatar::Leg make_leg(Scene const& scene, Pose const& rest, LegJoints const& joints, Avatar const& avatar);

/// Bends the leg with reach() so that the ankle is at its target and the foot has the target's orientation. For a
/// foot below the hip, the knee points forward, between the directions of the body and of the toes. For other foot
/// positions this direction is rotated along, so that it is undefined only for a foot above the hip. If the target
/// is out of reach, the heel rises by up to 0.9 rad about the ball of the foot, which stays in place; if it is
/// still out of reach, the leg is straight and the foot leaves the floor.
/// @param target  rigid, finite  @param body  world from body
void drive_leg(Scene const& scene, Avatar::Leg const& leg, dmat4 const& target, dquat const& body, Pose& pose);

} // namespace gi
