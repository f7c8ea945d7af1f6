#include "viewer/devices/tracking/pose_math.h"

#include <algorithm>
#include <cmath>

namespace viewer {

RoomPose between(RoomPose const& a, RoomPose const& b, double t)
{
    return {a.position + t * (b.position - a.position),
            glm::normalize(a.rotation *
                           gi::exp_rotation(t * gi::log_rotation(glm::inverse(a.rotation) * b.rotation)))};
}

RoomPose compose(RoomPose const& a, RoomPose const& b)
{
    return {a.position + a.rotation * b.position, glm::normalize(a.rotation * b.rotation)};
}

bool is_finite(RoomPose const& p)
{
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(p.position[i])) return false;
    return std::isfinite(p.rotation.w) && std::isfinite(p.rotation.x) && std::isfinite(p.rotation.y) &&
           std::isfinite(p.rotation.z);
}

gi::dquat heading_of(gi::dquat const& body)
{
    gi::dvec3 const forward = body * gi::dvec3{0, 0, -1}, top = body * gi::dvec3{0, 1, 0};
    return gi::exp_rotation(
        {0, std::atan2(-(forward.x - forward.y * top.x), -(forward.z - forward.y * top.z)), 0});
}

} // namespace viewer
