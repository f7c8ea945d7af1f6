#include "viewer/devices/tracking/pose_math.h"

#include <algorithm>
#include <cmath>

namespace viewer {

gi::dvec3 log_rotation(gi::dquat q)
{
    if (q.w < 0) q = -q;
    gi::dvec3 const v{q.x, q.y, q.z};
    double const sine = glm::length(v);
    if (sine < 1e-12) return 2.0 * v;
    return v * (2 * std::atan2(sine, q.w) / sine);
}

gi::dquat exp_rotation(gi::dvec3 r)
{
    double const angle = glm::length(r);
    double const scale = angle < 1e-12 ? 0.5 : std::sin(0.5 * angle) / angle;
    return glm::normalize(gi::dquat(std::cos(0.5 * angle), r.x * scale, r.y * scale, r.z * scale));
}

RoomPose between(RoomPose const& a, RoomPose const& b, double t)
{
    return {a.position + t * (b.position - a.position),
            glm::normalize(a.rotation * exp_rotation(t * log_rotation(glm::inverse(a.rotation) * b.rotation)))};
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
    return exp_rotation({0, std::atan2(-(forward.x - forward.y * top.x), -(forward.z - forward.y * top.z)), 0});
}

} // namespace viewer
