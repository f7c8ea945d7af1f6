#pragma once
// Panes between a surface and a lamp. Paths from the camera cannot meet a lamp without extent, so what lies behind
// thin glass is found by its shadow ray alone: the sheet keeps the direction, and takes its share of the light (no
// KHR_materials_volume: an infinitely thin sheet, both of whose faces reflect). Refracting glass turns the ray away.

#include "gi/render/coverage_test.h"
#include "gi/render/ray_query.h"

namespace gi {

/// The share of light that goes through a pane along a direction; where a texture or a metal makes it opaque, 0.
GI_FN inline vec3 pane_transmittance(WorldView const& world, std::uint32_t triangle, vec2 barycentric,
                                     vec3 direction)
{
    ShadingPoint const at = shading_point(world, triangle, barycentric, direction);
    vec3 const wo = at.frame.to_local(-direction);
    if (!(at.bsdf.clear > 0) || !(wo.z > 0)) return vec3{0};
    return at.bsdf.transmitted * (1 - bsdf_detail::GlassInterface(at.bsdf, wo, at.front).reflectance);
}

/// What panes leave of the light along one ray, in the order in which traversal meets them.
struct PaneCrossings {
    vec3 left{1};

    /// @param triangle  of a pane, which covers the ray at `barycentric`
    GI_FN void pass(WorldView const& world, RayQuery const& q, std::uint32_t triangle, vec2 barycentric)
    {
        constexpr float kRounding = 4e-7f;
        Surface const& surface = world.surfaces[triangle];
        vec3 const position = shading_detail::SurfacePoint{surface, barycentric}.position();
        float const distance = glm::dot(position - q.ray.origin, q.ray.direction);
        float const size = max_component(glm::abs(position) + glm::abs(surface.edge1) + glm::abs(surface.edge2));
        if (is_known(distance, kRounding * (size + distance))) return;
        distances_[count_++ % kKept] = distance;
        left *= pane_transmittance(world, triangle, barycentric, q.ray.direction);
    }

private:
    static constexpr int kKept = 8;
    /// A ray along the common edge of two triangles meets both, at distances that differ by rounding.
    GI_FN bool is_known(float distance, float rounding_m) const
    {
        for (int k = 0; k < kKept && k < count_; ++k)
            if (std::abs(distances_[k] - distance) <= rounding_m) return true;
        return false;
    }

    float distances_[kKept]{};
    int count_ = 0;
};

} // namespace gi
