#pragma once
// Poses of a runtime as poses and cameras in the room, and back.

#include "viewer/devices/xr/frame.h"

namespace viewer {

/// First b, then a: room from body = (room from space) after (space from body).
RoomPose after(RoomPose const& a, RoomPose const& b);
RoomPose inverse(RoomPose const& pose);
/// Turned to unit length in double precision; the identity where the quaternion is none.
RoomPose pose_of(std::array<float, 4> const& rotation_xyzw, std::array<float, 3> const& position);
RoomPose pose_of(HmdRawView const& view);
/// Tangents of the four angles; false where they span no view (also beyond 89.9 degrees).
bool spans_view(HmdRawView const& view);
gi::ViewTangents tangents(HmdRawView const& view);
/// The camera of an eye, in the room.
gi::Camera eye_camera(HmdEye eye, RoomPose const& room_from_eye, gi::ViewTangents const& tangents);
/// Angle about +Y from -Z to where the body faces, rad, counter-clockwise from above. One that looks straight up
/// or down faces where the top of its head, or its back, tells.
double heading_rad(gi::dquat const& rotation);
/// The room from the runtime's space such that the head is at x = z = 0 and faces -Z. Heights are kept.
RoomPose centred(RoomPose const& space_from_head, double floor_m);

} // namespace viewer
