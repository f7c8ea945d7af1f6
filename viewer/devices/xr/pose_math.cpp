#include "viewer/devices/xr/pose_math.h"

#include <glm/gtc/matrix_transform.hpp>

namespace viewer {

RoomPose pose_of(std::array<float, 4> const& q, std::array<float, 3> const& p)
{
    gi::dquat const rotation(q[3], q[0], q[1], q[2]);
    double const length = glm::length(rotation);
    bool const is_rotation = std::isfinite(length) && length > 0.5;
    return {{p[0], p[1], p[2]}, is_rotation ? rotation / length : gi::dquat(1, 0, 0, 0)};
}

RoomPose pose_of(HmdRawView const& view) { return pose_of(view.rotation, view.position); }

bool spans_view(HmdRawView const& view)
{
    auto const [left, right, up, down] = view.fov_rad;
    for (float const angle : view.fov_rad)
        if (!(std::abs(angle) < 1.569f)) return false;
    return left < right && down < up;
}

gi::ViewTangents tangents(HmdRawView const& view)
{
    auto const [left, right, up, down] = view.fov_rad;
    return {std::tan(double(left)), std::tan(double(right)), std::tan(double(down)), std::tan(double(up))};
}

gi::Camera eye_camera(HmdEye eye, RoomPose const& room_from_eye, gi::ViewTangents const& view)
{
    gi::Camera camera;
    camera.name = eye == HmdEye::left ? "left eye" : "right eye";
    camera.off_axis = view;
    camera.yfov_rad = std::atan(view.top) - std::atan(view.bottom);
    camera.world_from_camera =
        glm::translate(gi::dmat4(1), room_from_eye.position) * glm::mat4_cast(room_from_eye.rotation);
    return camera;
}

double heading_rad(gi::dquat const& rotation)
{
    gi::dvec3 const forward = rotation * gi::dvec3(0, 0, -1);
    gi::dvec3 const up = rotation * gi::dvec3(0, 1, 0);
    bool const steep = forward.x * forward.x + forward.z * forward.z < 1e-6;
    gi::dvec3 const faced = !steep ? forward : forward.y < 0 ? up : -up;
    return std::atan2(-faced.x, -faced.z);
}

RoomPose centred(RoomPose const& space_from_head, double floor_m)
{
    gi::dquat const turn = glm::angleAxis(-heading_rad(space_from_head.rotation), gi::dvec3(0, 1, 0));
    gi::dvec3 const head(space_from_head.position.x, 0, space_from_head.position.z);
    return {gi::dvec3(0, floor_m, 0) - turn * head, turn};
}

} // namespace viewer
