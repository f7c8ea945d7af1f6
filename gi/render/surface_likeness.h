#pragma once
// Weights by which a surface takes light from another one nearby.

#include "gi/core/math.h"

namespace gi {

/// Similarity of two surfaces that are near each other, 0..1, for taking light from one to the other.
/// @param a, b  unit normals  @param off  distance of one from the other's plane, over that at which
///   another surface begins
GI_FN inline float surface_likeness(vec3 a, vec3 b, float off)
{
    float const cosine = glm::max(0.0f, glm::dot(a, b));
    float const cosine2 = cosine * cosine, cosine8 = cosine2 * cosine2 * cosine2 * cosine2;
    return cosine8 / (1 + off * off * off * off);
}

/// Least weight of a surface that is not alike: small objects between those that have light get some of it,
/// instead of turning dark.
inline constexpr float kLeastLikeness = 1e-4f;

} // namespace gi
