#pragma once
// Arithmetic of poses.

#include "gi/core/rotation.h"
#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Position and rotation on the straight way from a (t = 0) to b (t = 1).
RoomPose between(RoomPose const& a, RoomPose const& b, double t);
/// a after b: room from b's frame.
RoomPose compose(RoomPose const& a, RoomPose const& b);
bool is_finite(RoomPose const& pose);
/// The turn about the vertical of a body that looks so, also straight up or down.
gi::dquat heading_of(gi::dquat const& body);

} // namespace viewer
