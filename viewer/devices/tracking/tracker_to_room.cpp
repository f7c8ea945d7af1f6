#include "viewer/devices/tracking/tracker_to_room.h"

#include "gi/core/pose.h"

namespace viewer {
namespace {

/// Columns: directions of the tracker's x, y, z in the room's axes.
glm::dmat3 room_from(TrackerAxes axes)
{
    switch (axes) {
    case TrackerAxes::z_up:
        return {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    case TrackerAxes::left_handed_y_up:
        return {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
    case TrackerAxes::left_handed_z_up:
        return {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}};
    case TrackerAxes::y_up:
        break;
    }
    return glm::dmat3(1);
}

} // namespace

RoomPose to_room(TrackerToRoom const& t, RoomPose const& pose, RoomPose const& sensor_from_body)
{
    glm::dmat3 const c = room_from(t.axes);
    RoomPose p{c * pose.position * t.metres_per_unit, pose.rotation};
    // A rotation about an axis a becomes, in the new axes, a rotation about C a,
    // in the opposite sense if C mirrors.
    gi::dvec3 const axis = glm::determinant(c) * (c * gi::dvec3{p.rotation.x, p.rotation.y, p.rotation.z});
    p.rotation = glm::normalize(gi::dquat(p.rotation.w, axis.x, axis.y, axis.z));
    return t.room_from_tracker * p * sensor_from_body;
}

} // namespace viewer
