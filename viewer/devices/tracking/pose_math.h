#pragma once
// Interpolation and composition of poses.

#include "gi/core/rotation.h"
#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Interpolates position and rotation from a (t = 0) to b (t = 1).
RoomPose between(RoomPose const& a, RoomPose const& b, double t);
/// Composition, a after b: room from b's frame.
RoomPose compose(RoomPose const& a, RoomPose const& b);
bool is_finite(RoomPose const& pose);
/// Yaw of a body with this orientation, also if it looks straight up or down.
gi::dquat heading_of(gi::dquat const& body);

} // namespace viewer
