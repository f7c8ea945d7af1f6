#pragma once
// Maps from uniform numbers in [0, 1)^2 to directions and points.

#include "gi/core/math.h"

namespace gi {

/// (cos, sin) of q * pi/4, |q| <= 1: Taylor polynomials, errors below 2e-7. Library functions would spend most
/// of their time on range reduction.
GI_FN inline vec2 eighth_turn(float q)
{
    float const a = 0.25f * kPi * q, a2 = a * a;
    float const c = 1 + a2 * (-1.0f / 2 + a2 * (1.0f / 24 + a2 * (-1.0f / 720 + a2 * (1.0f / 40320))));
    float const s = a * (1 + a2 * (-1.0f / 6 + a2 * (1.0f / 120 + a2 * (-1.0f / 5040 + a2 * (1.0f / 362880)))));
    return {c, s};
}

/// Area-preserving map of the square to the unit disk (Shirley & Chiu 1997).
GI_FN inline vec2 square_to_disk(vec2 u)
{
    vec2 const p = 2.0f * u - 1.0f;
    bool const wide = std::abs(p.x) > std::abs(p.y);
    float const radius = wide ? p.x : p.y;
    if (radius == 0) return vec2{0};
    vec2 const d = radius * eighth_turn((wide ? p.y : p.x) / radius);
    return {wide ? d.x : d.y, wide ? d.y : d.x};
}

/// Direction about +z with density cos(theta) / pi.
GI_FN inline vec3 square_to_cosine_hemisphere(vec2 u)
{
    vec2 const d = square_to_disk(u);
    return {d.x, d.y, std::sqrt(glm::max(0.0f, 1 - glm::dot(d, d)))};
}

/// Uniform point in a triangle, as weights of vertices 1 and 2 (Heitz 2019, "A Low-Distortion
/// Map Between Triangle and Square").
GI_FN inline vec2 square_to_triangle(vec2 u)
{
    float const half = 0.5f * glm::min(u.x, u.y);
    return {u.x - half, u.y - half};
}

/// (cos, sin) of u turns, u in [0, 1].
GI_FN inline vec2 azimuth(float u)
{
    float const quarter = std::floor(4 * u + 0.5f);
    vec2 const d = eighth_turn(2 * (4 * u - quarter));
    int const turns = int(quarter) & 3;
    vec2 const turned = (turns & 1) != 0 ? vec2{-d.y, d.x} : d;
    return (turns & 2) != 0 ? -turned : turned;
}

} // namespace gi
