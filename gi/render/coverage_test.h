#pragma once
// Partly transparent surfaces met by rays: a random decision per ray and triangle,
// the same in any order of traversal.

#include "gi/core/rng.h"
#include "gi/scene/shading/shading_point.h"

namespace gi {

/// True if a ray hits the triangle there rather than passing through. @param seed  of the ray
GI_FN inline bool covers(WorldView const& world, std::uint32_t triangle, vec2 barycentric, std::uint32_t seed)
{
    float const covered = coverage(world, triangle, barycentric);
    if (covered >= 1) return true;
    std::uint64_t const key = (std::uint64_t(seed) << 32) | triangle;
    return float(mix_bits(key) >> 40) * 0x1p-24f < covered;
}

} // namespace gi
