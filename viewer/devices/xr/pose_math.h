#pragma once
// Conversion of a runtime's poses to poses and cameras in the room, and back.

#include "viewer/devices/xr/frame.h"

namespace viewer {

/// Normalised in double precision; the identity if the quaternion is invalid.
RoomPose pose_of(std::array<float, 4> const& rotation_xyzw, std::array<float, 3> const& position);
RoomPose pose_of(HmdRawView const& view);
/// Tangents of the four angles; false if they span no valid view (also beyond 89.9 degrees).
bool spans_view(HmdRawView const& view);
gi::ViewTangents tangents(HmdRawView const& view);
/// The camera of an eye, in the room.
gi::Camera eye_camera(HmdEye eye, RoomPose const& room_from_eye, gi::ViewTangents const& tangents);
/// Yaw: angle about +Y from -Z to the body's forward direction, rad, counter-clockwise from above. If it looks
/// straight up or down, the direction of its top or back is used.
double heading_rad(gi::dquat const& rotation);
/// Room from the runtime's space such that the head is at x = z = 0 and faces -Z. Heights are kept.
RoomPose centred(RoomPose const& space_from_head, double floor_m);

} // namespace viewer
