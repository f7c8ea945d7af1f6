#pragma once
// Rotation vectors, and interpolation and composition of poses.

#include "gi/core/rotation.h"
#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Rotation vector (axis times angle, rad) of a unit quaternion; the shorter rotation, so its length is at most
/// pi.
gi::dvec3 gi::log_rotation(gi::dquat rotation);
/// The unit quaternion of a rotation vector.
gi::dquat gi::exp_rotation(gi::dvec3 vector_rad);
/// Interpolates position and rotation from a (t = 0) to b (t = 1).
RoomPose between(RoomPose const& a, RoomPose const& b, double t);
/// Composition, a after b: room from b's frame.
RoomPose compose(RoomPose const& a, RoomPose const& b);
bool is_finite(RoomPose const& pose);
/// Yaw of a body with this orientation, also if it looks straight up or down.
gi::dquat heading_of(gi::dquat const& body);

} // namespace viewer
