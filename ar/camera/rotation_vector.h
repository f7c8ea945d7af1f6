#pragma once
// Rotations as vectors: axis times angle.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace ar {

/// The unit quaternion of a rotation vector (axis times angle, rad), and back (at most pi long).
glm::dquat exp_rotation(glm::dvec3 vector_rad);
glm::dvec3 log_rotation(glm::dquat const& rotation);

} // namespace ar
