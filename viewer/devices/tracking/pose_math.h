#pragma once
// Rotations as vectors and between poses.

#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Rotation vector (axis times angle, rad) of a unit quaternion; the shorter way, so at most pi long.
gi::dvec3 log_rotation(gi::dquat rotation);
/// The unit quaternion of a rotation vector.
gi::dquat exp_rotation(gi::dvec3 vector_rad);
/// Position and rotation on the straight way from a (t = 0) to b (t = 1).
RoomPose between(RoomPose const& a, RoomPose const& b, double t);
/// a after b: room from b's frame.
RoomPose compose(RoomPose const& a, RoomPose const& b);
bool is_finite(RoomPose const& pose);
/// The turn about the vertical of a body that looks so, also straight up or down.
gi::dquat heading_of(gi::dquat const& body);

} // namespace viewer
