#pragma once
#include "viewer/devices/tracking/pose_math.h"

#include <glm/glm.hpp>

namespace viewer::test {

inline RoomPose inverted(RoomPose const& a)
{
    gi::dquat const back = glm::inverse(a.rotation);
    return {-(back * a.position), back};
}

inline gi::dmat4 to_matrix(RoomPose const& pose)
{
    gi::dmat4 m = glm::mat4_cast(pose.rotation);
    m[3] = glm::dvec4(pose.position, 1);
    return m;
}

/// Angle between two orientations, rad, 0..pi.
inline double angle_between(gi::dquat const& a, gi::dquat const& b)
{
    return glm::length(gi::log_rotation(glm::inverse(a) * b));
}

} // namespace viewer::test
