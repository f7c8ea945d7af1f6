#pragma once
// Watertight intersection of a ray and a triangle (Woop, Benthin and Wald 2013): corners are sheared so that the
// ray runs along z, and tested in the plane by the signs of their edges. A corner has the same place in the plane
// for all of its triangles, and signs are exact (Kahan's difference of products), so that no ray passes between
// neighbours, nor through a corner.

#include "gi/core/math.h"

namespace gi {

/// The shear of a ray.
struct RayShear {
    int x, y, z; ///< axes; z is the one along which the direction is longest
    float shear_x, shear_y, scale_z;

    GI_FN explicit RayShear(vec3 direction)
    {
        vec3 const size = glm::abs(direction);
        z = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        x = z == 2 ? 0 : z + 1;
        y = x == 2 ? 0 : x + 1;
        scale_z = 1 / direction[z];
        shear_x = direction[x] * scale_z;
        shear_y = direction[y] * scale_z;
    }
};

/// a b - c d with an error of 1.5 ulp, and so with the right sign. Explicitly fused,
/// so that all compilers round alike.
GI_FN inline float difference_of_products(float a, float b, float c, float d)
{
    float const cd = c * d, error = std::fma(c, d, -cd);
    return std::fma(a, b, -cd) - error;
}

struct TriangleHit {
    float distance = kInf; ///< kInf = none
    vec2 weights{0};       ///< of corners 1 and 2
};

/// @param a, b, c  corners relative to the ray's origin, m, their coordinates in the order x, y, z of the shear
/// @param start, reach  allowed distances, in lengths of the direction
GI_FN inline TriangleHit meet_sheared(vec3 a, vec3 b, vec3 c, RayShear const& s, float start, float reach)
{
    float const ax = std::fma(-s.shear_x, a.z, a.x), ay = std::fma(-s.shear_y, a.z, a.y);
    float const bx = std::fma(-s.shear_x, b.z, b.x), by = std::fma(-s.shear_y, b.z, b.y);
    float const cx = std::fma(-s.shear_x, c.z, c.x), cy = std::fma(-s.shear_y, c.z, c.y);
    float const u = difference_of_products(cx, by, cy, bx), v = difference_of_products(ax, cy, ay, cx),
                w = difference_of_products(bx, ay, by, ax);
    if (glm::min(u, glm::min(v, w)) < 0 && glm::max(u, glm::max(v, w)) > 0) return {};
    float const sum = u + v + w;
    if (sum == 0) return {};
    float const height = std::fma(u, a.z, std::fma(v, b.z, w * c.z));
    float const t = height * s.scale_z / sum;
    if (!(t >= start && t <= reach)) return {};
    return {t, {v / sum, w / sum}};
}

/// The same, coordinates in the order of the world.
GI_FN inline TriangleHit meet_triangle(vec3 a, vec3 b, vec3 c, RayShear const& s, float start, float reach)
{
    auto const turned = [&](vec3 v) { return vec3{v[s.x], v[s.y], v[s.z]}; };
    return meet_sheared(turned(a), turned(b), turned(c), s, start, reach);
}

} // namespace gi
