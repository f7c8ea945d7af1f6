#pragma once
// The rotation that takes one set of vectors to another.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <span>

namespace ar {

/// The R that makes sum_i weight_i |to_i - R from_i|^2 least (Kabsch 1976, by the singular value decomposition of
/// sum weight to from^T; never a reflection). Nothing where the vectors do not determine it: all parallel, zero or
/// not finite.
/// @param from,to as many of one as of the other
/// @param weights none = all 1
std::optional<glm::dquat> rotation_fit(std::span<glm::dvec3 const> from, std::span<glm::dvec3 const> to,
                                       std::span<double const> weights = {});

/// The unit quaternion of a rotation vector (axis times angle, rad), and back (at most pi long).
glm::dquat exp_rotation(glm::dvec3 vector_rad);
glm::dvec3 log_rotation(glm::dquat const& rotation);

} // namespace ar
