#pragma once
// Surfaces that rays of the grids meet: where, which side, and whether it is smooth. Unlike shading_point()
// without what only light needs, most of all textures; what is here is the same bit for bit.

#include "gi/scene/shading/shading_point.h"

namespace gi {

struct MetSurface {
    vec3 position;
    vec3 geometric_normal; ///< unit, towards the ray's start
    bool front;            ///< the ray meets the counter-clockwise side
    bool smooth;           ///< only mirrors and refracts: all of its lobes are delta
};

namespace met_detail {

/// True if the material has a lobe that is not delta whatever its textures and vertex colours.
inline bool always_scatters(Material const& m, Bsdf const& untextured)
{
    if (m.model == MaterialModel::phong) return max_component(m.phong_specular) > 0;
    return m.metallic_roughness_map.texture < 0 && m.specular_map.texture < 0 && untextured.f90.x > 0 &&
           !bsdf_detail::specular_is_delta(untextured);
}

inline bool is_smooth(WorldView const& world, Surface const& surface, vec2 barycentric)
{
    Bsdf const& untextured = world.bsdfs[surface.material];
    if (!surface.is(Surface::kVaries)) return only_delta(untextured);
    Material const& m = world.materials[surface.material];
    if (always_scatters(m, untextured)) return false;
    shading_detail::SurfacePoint s{surface, barycentric};
    shading_detail::interpolate_uv(world, s);
    return only_delta(make_bsdf(m, shading_detail::look_up_factors(world, m, s)));
}

} // namespace met_detail

/// @param direction  of the ray, unit
inline MetSurface met_surface(WorldView const& world, std::uint32_t triangle, vec2 barycentric, vec3 direction)
{
    Surface const& surface = world.surfaces[triangle];
    vec3 const normal = shading_detail::triangle_normal(surface);
    bool const front = glm::dot(direction, normal) < 0;
    return {shading_detail::SurfacePoint{surface, barycentric}.position(), (front ? 1.0f : -1.0f) * normal, front,
            met_detail::is_smooth(world, surface, barycentric)};
}

} // namespace gi
