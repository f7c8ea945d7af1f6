#pragma once
// Shading data at a ray hit: interpolated attributes, evaluated textures, a shading frame.

#include "gi/scene/model/world.h"
#include "gi/scene/shading/bsdf.h"

namespace gi {

struct ShadingPoint {
    vec3 position;         ///< on the triangle (from barycentrics, not from the ray)
    vec3 geometric_normal; ///< unit, towards the viewer's side
    Frame frame;           ///< about the shading normal (interpolated, normal-mapped), same side
    bool front;            ///< viewer is on the counter-clockwise side
    Bsdf bsdf;
    vec3 emission;   ///< radiance leaving towards the viewer (0 on the dark side)
    float clearance; ///< m; offset from the surface at which rays must start
};

/// @param barycentric  weights of vertices 1 and 2 (Embree's u, v)
/// @param direction    direction of the arriving ray, unit
GI_FN ShadingPoint shading_point(WorldView const& world, std::uint32_t triangle, vec2 barycentric, vec3 direction);

/// Returns the start of a ray along `direction`, offset from the surface to that side (m). @param direction unit
GI_FN inline vec3 leave(ShadingPoint const& at, vec3 direction)
{
    return at.position +
           (glm::dot(direction, at.geometric_normal) > 0 ? at.clearance : -at.clearance) * at.geometric_normal;
}

/// Value of the layer "albedo": diffuse + normal-incidence reflectance + transmitted, independent of directions.
GI_FN vec3 albedo(Bsdf const& bsdf);

/// Coverage of the surface there, 0..1: 1 for opaque materials, 0 or 1 for masks, alpha for blend.
GI_FN float coverage(WorldView const& world, std::uint32_t triangle, vec2 barycentric);

/// Weights of vertices 1 and 2 at a point on (or near) a triangle, within the triangle.
GI_FN inline vec2 barycentric_at(Surface const& s, vec3 position)
{
    vec3 const p = position - s.corner;
    float const a = glm::dot(s.edge1, s.edge1), b = glm::dot(s.edge1, s.edge2), c = glm::dot(s.edge2, s.edge2);
    float const p1 = glm::dot(p, s.edge1), p2 = glm::dot(p, s.edge2), determinant = a * c - b * b;
    if (!(determinant > 0)) return vec2{1.0f / 3};
    vec2 w{(c * p1 - b * p2) / determinant, (a * p2 - b * p1) / determinant};
    if (!(w.x == w.x) || !(w.y == w.y)) return vec2{1.0f / 3};
    w = glm::clamp(w, 0.0f, 1.0f);
    float const sum = w.x + w.y;
    return sum > 1 ? w / sum : w;
}

} // namespace gi

#include "gi/scene/shading/shading_point.inl.h"
