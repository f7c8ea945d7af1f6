#include "viewer/displays/placement.h"

#include <algorithm>
#include <cmath>

namespace viewer {

RoomPose pose_of(Placement const& p)
{
    gi::dvec3 const a = glm::radians(p.rotation_deg);
    gi::dquat const rotation = glm::angleAxis(a.z, gi::dvec3{0, 0, 1}) * glm::angleAxis(a.y, gi::dvec3{0, 1, 0}) *
                               glm::angleAxis(a.x, gi::dvec3{1, 0, 0});
    return {p.translation_m, glm::normalize(rotation)};
}

Placement placement_of(RoomPose const& pose)
{
    glm::dmat3 const m(glm::normalize(pose.rotation)); // m[column][row]; R = Rz Ry Rx
    gi::dvec3 a{std::atan2(m[1][2], m[2][2]), std::asin(std::clamp(-m[0][2], -1.0, 1.0)),
                std::atan2(m[0][1], m[0][0])};
    if (std::abs(m[0][2]) > 1 - 1e-12) { // looks along y: only one angle about it
        a.x = std::atan2(-m[2][1], m[1][1]);
        a.z = 0;
    }
    gi::dvec3 degrees = glm::degrees(a);
    for (int i = 0; i < 3; ++i) degrees[i] = std::abs(degrees[i]) < 1e-9 ? 0 : degrees[i];
    return {pose.position, degrees};
}

} // namespace viewer
