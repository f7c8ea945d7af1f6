#pragma once
// Vectors, constants and orthonormal frames. World space is right-handed, +Y up, one unit = one metre.

#include "gi/core/platform.h"

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace gi {

using glm::dmat4;
using glm::dquat;
using glm::dvec3;
using glm::mat3;
using glm::mat4;
using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr double kPiD = 3.14159265358979323846;
inline constexpr float kInvPi = 0.31830988618379067154f;
inline constexpr float kInf = 3.402823466e+38f;
inline constexpr float kFarthest = 1e18f; ///< m; the square of a larger coordinate overflows a float

/// Rec. 709 luminance of linear RGB.
GI_FN inline float luminance(vec3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
GI_FN inline float max_component(vec3 c) { return glm::max(c.x, glm::max(c.y, c.z)); }
GI_FN inline float min_component(vec3 c) { return glm::min(c.x, glm::min(c.y, c.z)); }
GI_FN inline float square(float x) { return x * x; }
GI_FN inline bool all_finite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Right-handed orthonormal frame about a unit normal n (Duff et al. 2017, "Building an Orthonormal
/// Basis, Revisited", listing 3: no branch, no singularity).
struct Frame {
    vec3 tangent, bitangent, normal;

    GI_FN static Frame about(vec3 n)
    {
        float const sign = std::copysign(1.0f, n.z);
        float const a = -1.0f / (sign + n.z);
        float const b = n.x * n.y * a;
        return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
    }
    GI_FN vec3 to_local(vec3 v) const
    {
        return {glm::dot(v, tangent), glm::dot(v, bitangent), glm::dot(v, normal)};
    }
    GI_FN vec3 to_world(vec3 v) const { return v.x * tangent + v.y * bitangent + v.z * normal; }
};

} // namespace gi
