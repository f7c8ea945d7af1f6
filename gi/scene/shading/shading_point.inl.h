#pragma once
// Implementation of shading_point.h.

#include "gi/scene/shading/texture_lookup.h"

namespace gi {
namespace shading_detail {

/// Scales a vector such that its largest component is 1, so that products neither overflow nor underflow.
GI_FN inline vec3 rescale(vec3 v)
{
    float const m = max_component(glm::abs(v));
    return m > 0 ? v / m : v;
}

/// Unit normal on the counter-clockwise side.
GI_FN inline vec3 triangle_normal(Surface const& s)
{
    if (s.normal_scale > 0) return glm::cross(s.edge1, s.edge2) * s.normal_scale;
    return glm::normalize(rescale(glm::cross(rescale(s.edge1), rescale(s.edge2))));
}

/// A point of a triangle.
struct SurfacePoint {
    Surface const& surface;
    vec2 barycentric; ///< weights of vertices 1 and 2
    vec2 uv0{0}, uv1{0};

    template <class T>
    GI_FN T interpolate(View<T const> const& attribute) const
    {
        uvec3 const v = surface.vertex;
        return (1 - barycentric.x - barycentric.y) * attribute[v.x] + barycentric.x * attribute[v.y] +
               barycentric.y * attribute[v.z];
    }
    GI_FN vec3 position() const
    {
        return surface.corner + barycentric.x * surface.edge1 + barycentric.y * surface.edge2;
    }
};

/// Interpolates texture coordinates, for materials with textures.
GI_FN inline void interpolate_uv(WorldView const& world, SurfacePoint& s)
{
    if (!world.uv0.empty()) s.uv0 = s.interpolate(world.uv0);
    if (!world.uv1.empty()) s.uv1 = s.interpolate(world.uv1);
}

/// Tangent dP/du of the given UV set, with the handedness that makes the bitangent -dP/dv (v points down); zero if
/// the coordinates are degenerate.
GI_FN inline vec4 tangent_from_uv(WorldView const& world, SurfacePoint const& s, std::uint8_t uv_set)
{
    View<vec2 const> const& uv = uv_set == 0 ? world.uv0 : world.uv1;
    if (uv.empty()) return vec4{0};
    uvec3 const v = s.surface.vertex;
    vec2 const a = uv[v.y] - uv[v.x], b = uv[v.z] - uv[v.x];
    float const determinant = a.x * b.y - a.y * b.x;
    if (determinant == 0) return vec4{0};
    vec3 const tangent = b.y * s.surface.edge1 - a.y * s.surface.edge2;
    return determinant > 0 ? vec4{tangent, -1} : vec4{-tangent, 1};
}

/// @param n unit shading normal of the front
GI_FN inline vec3 apply_normal_map(WorldView const& world, SurfacePoint const& s, Material const& m, vec3 n)
{
    vec4 given{0};
    if (!world.tangents.empty()) given = s.interpolate(world.tangents);
    if (vec3(given) == vec3{0}) given = tangent_from_uv(world, s, m.normal_map.uv_set);
    vec3 tangent = rescale(vec3(given));
    tangent -= glm::dot(tangent, n) * n;
    float const length = glm::length(tangent);
    if (!(length > 1e-6f)) return n;
    tangent /= length;
    vec3 const bitangent = (given.w < 0 ? -1.0f : 1.0f) * glm::cross(n, tangent);
    vec3 const texel = vec3(look_up(world.textures, m.normal_map, s.uv0, s.uv1)) * 2.0f - 1.0f;
    vec3 const mapped = m.normal_scale * (texel.x * tangent + texel.y * bitangent) + texel.z * n;
    float const mapped_length = glm::length(mapped);
    return mapped_length > 1e-6f ? mapped / mapped_length : n;
}

GI_FN inline MaterialFactors look_up_factors(WorldView const& world, Material const& m, SurfacePoint const& s)
{
    MaterialFactors f{m.base_color, m.metallic, m.roughness, m.specular, m.specular_color, m.transmission};
    if (m.base_color_map.texture >= 0)
        f.base_color *= vec3(look_up(world.textures, m.base_color_map, s.uv0, s.uv1));
    if (!world.colors.empty()) f.base_color *= s.interpolate(world.colors);
    if (m.metallic_roughness_map.texture >= 0) {
        vec4 const t = look_up(world.textures, m.metallic_roughness_map, s.uv0, s.uv1);
        f.roughness *= t.y;
        f.metallic *= t.z;
    }
    if (m.specular_map.texture >= 0) f.specular *= look_up(world.textures, m.specular_map, s.uv0, s.uv1).w;
    if (m.specular_color_map.texture >= 0)
        f.specular_color *= vec3(look_up(world.textures, m.specular_color_map, s.uv0, s.uv1));
    if (m.transmission_map.texture >= 0)
        f.transmission *= look_up(world.textures, m.transmission_map, s.uv0, s.uv1).x;
    return f;
}

/// Emitted radiance of the material at a point, on the side that emits.
GI_FN inline vec3 look_up_emission(WorldView const& world, Material const& m, SurfacePoint const& s)
{
    if (m.emissive_map.texture < 0) return m.emission;
    return m.emission * vec3(look_up(world.textures, m.emissive_map, s.uv0, s.uv1));
}

/// Bends a normal until it just faces the viewer: interpolated and mapped normals may point away, but a visible
/// surface must scatter towards the eye.
GI_FN inline vec3 face_viewer(vec3 n, vec3 to_viewer)
{
    constexpr float kLeast = 1e-3f;
    float const cosine = glm::dot(n, to_viewer);
    if (cosine >= kLeast) return n;
    return glm::normalize(n + (2 * kLeast - cosine) * to_viewer);
}

} // namespace shading_detail

GI_FN inline ShadingPoint shading_point(WorldView const& world, std::uint32_t triangle, vec2 barycentric,
                                        vec3 direction)
{
    using namespace shading_detail;
    Surface const& surface = world.surfaces[triangle];
    SurfacePoint s{surface, barycentric};
    bool const varies = surface.is(Surface::kVaries);
    if (varies) interpolate_uv(world, s);
    ShadingPoint at;
    at.clearance = surface.clearance;
    at.position = s.position();
    vec3 const winding_normal = triangle_normal(surface);
    at.front = glm::dot(direction, winding_normal) < 0;
    float const side = at.front ? 1.0f : -1.0f;
    at.geometric_normal = side * winding_normal;

    Material const& m = world.materials[surface.material];
    vec3 n = side * winding_normal;
    bool bent = false;
    if (surface.is(Surface::kSmooth)) {
        vec3 const smooth = s.interpolate(world.normals);
        float const squared = glm::dot(smooth, smooth);
        if (squared > 1e-12f) {
            n = smooth * (1 / std::sqrt(squared));
            bent = true;
        }
    }
    if (varies && m.normal_map.texture >= 0) {
        n = apply_normal_map(world, s, m, bent ? n : winding_normal);
        bent = true;
    }
    if (bent) {
        if (glm::dot(n, at.geometric_normal) < 0) n = -n;
        n = face_viewer(n, -direction);
    }
    at.frame = Frame::about(n);
    at.bsdf = varies ? make_bsdf(m, look_up_factors(world, m, s)) : world.bsdfs[surface.material];
    at.emission = vec3{0};
    if (surface.is(Surface::kEmits) && (at.front || surface.is(Surface::kDoubleSided)))
        at.emission = look_up_emission(world, m, s);
    return at;
}

GI_FN inline vec3 albedo(Bsdf const& b)
{
    vec3 const reflected = b.model == MaterialModel::phong ? b.phong_specular : b.f0;
    return glm::min(b.diffuse + reflected + b.transmitted, vec3{1});
}

GI_FN inline float coverage(WorldView const& world, std::uint32_t triangle, vec2 barycentric)
{
    using namespace shading_detail;
    Surface const& surface = world.surfaces[triangle];
    Material const& m = world.materials[surface.material];
    if (m.alpha_mode == AlphaMode::opaque) return 1;
    float alpha = m.alpha;
    SurfacePoint s{surface, barycentric};
    if (!world.alphas.empty()) alpha *= s.interpolate(world.alphas);
    if (m.base_color_map.texture >= 0) {
        interpolate_uv(world, s);
        alpha *= look_up(world.textures, m.base_color_map, s.uv0, s.uv1).w;
    }
    if (m.alpha_mode == AlphaMode::mask) return alpha >= m.alpha_cutoff ? 1.0f : 0.0f;
    return glm::clamp(alpha, 0.0f, 1.0f);
}

} // namespace gi
