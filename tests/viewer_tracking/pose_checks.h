#pragma once
// Comparisons of poses and rotations for tests.

#include "gi/core/pose.h"

#include <glm/glm.hpp>

namespace viewer::test {

inline gi::dmat4 to_matrix(gi::RigidPose const& pose)
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
