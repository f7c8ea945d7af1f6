#pragma once
// From uniform numbers in [0, 1)^2 to directions and points.

#include "gi/base/math.h"

namespace gi {

/// Area-preserving map of the square to the unit disk (Shirley & Chiu 1997).
GI_FN inline vec2 square_to_disk(vec2 u)
{
    vec2 const p = 2.0f * u - 1.0f;
    if (p.x == 0 && p.y == 0) return vec2{0};
    bool const wide = std::abs(p.x) > std::abs(p.y);
    float const radius = wide ? p.x : p.y;
    float const angle = wide ? 0.25f * kPi * (p.y / p.x) : 0.5f * kPi - 0.25f * kPi * (p.x / p.y);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Density cos(theta) / pi about +z.
GI_FN inline vec3 square_to_cosine_hemisphere(vec2 u)
{
    vec2 const d = square_to_disk(u);
    return {d.x, d.y, std::sqrt(glm::max(0.0f, 1 - glm::dot(d, d)))};
}

/// Uniform in a triangle: weights of vertices 1 and 2 (Heitz 2019, "A Low-Distortion Map Between Triangle and
/// Square").
GI_FN inline vec2 square_to_triangle(vec2 u)
{
    if (u.y > u.x) {
        float const x = 0.5f * u.x;
        return {x, u.y - x};
    }
    float const y = 0.5f * u.y;
    return {u.x - y, y};
}

/// The rotation of a direction about +z that an azimuth in [0, 1) stands for.
GI_FN inline vec2 azimuth(float u) { return {std::cos(2 * kPi * u), std::sin(2 * kPi * u)}; }

} // namespace gi
