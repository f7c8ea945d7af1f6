#pragma once
// Implementation of shading_point.h.

#include "gi/scene/texture_lookup.h"

namespace gi {
namespace shading_detail {

/// A vector of the same direction whose largest component is 1, so that products neither overflow nor vanish.
GI_FN inline vec3 rescale(vec3 v)
{
    float const m = max_component(glm::abs(v));
    return m > 0 ? v / m : v;
}

GI_FN inline vec3 triangle_normal(vec3 p0, vec3 p1, vec3 p2)
{
    vec3 const area = glm::cross(p1 - p0, p2 - p0);
    float const squared = glm::dot(area, area);
    if (squared > 1e-30f && squared < 1e30f) return area / std::sqrt(squared);
    return glm::normalize(rescale(glm::cross(rescale(p1 - p0), rescale(p2 - p0))));
}

/// Attributes of one triangle at one point.
struct SurfacePoint {
    uvec3 vertex;
    vec3 weight; ///< of the three vertices
    vec2 uv0{0}, uv1{0};

    template <class T>
    GI_FN T interpolate(View<T const> const& attribute) const
    {
        return weight.x * attribute[vertex.x] + weight.y * attribute[vertex.y] + weight.z * attribute[vertex.z];
    }
};

GI_FN inline SurfacePoint surface_point(WorldView const& world, std::uint32_t triangle, vec2 barycentric)
{
    SurfacePoint s;
    s.vertex = world.triangles[triangle];
    s.weight = {1 - barycentric.x - barycentric.y, barycentric.x, barycentric.y};
    return s;
}

/// Texture coordinates, for materials that have textures.
GI_FN inline void interpolate_uv(WorldView const& world, SurfacePoint& s)
{
    if (!world.uv0.empty()) s.uv0 = s.interpolate(world.uv0);
    if (!world.uv1.empty()) s.uv1 = s.interpolate(world.uv1);
}

/// dP/du of the coordinates that the map uses, and the handedness that makes the bitangent -dP/dv (v points down);
/// zero where they do not span a plane.
GI_FN inline vec4 tangent_from_uv(WorldView const& world, SurfacePoint const& s, std::uint8_t uv_set)
{
    View<vec2 const> const& uv = uv_set == 0 ? world.uv0 : world.uv1;
    if (uv.empty()) return vec4{0};
    vec2 const a = uv[s.vertex.y] - uv[s.vertex.x], b = uv[s.vertex.z] - uv[s.vertex.x];
    float const determinant = a.x * b.y - a.y * b.x;
    if (determinant == 0) return vec4{0};
    vec3 const p = world.positions[s.vertex.x];
    vec3 const tangent = b.y * (world.positions[s.vertex.y] - p) - a.y * (world.positions[s.vertex.z] - p);
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

/// Emitted radiance of the material there, on the side that emits.
GI_FN inline vec3 look_up_emission(WorldView const& world, Material const& m, SurfacePoint const& s)
{
    if (m.emissive_map.texture < 0) return m.emission;
    return m.emission * vec3(look_up(world.textures, m.emissive_map, s.uv0, s.uv1));
}

/// Interpolated and mapped normals may point away from the viewer; they are bent until they just face him, for a
/// surface that one sees has to scatter towards the eye.
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
    SurfacePoint s = surface_point(world, triangle, barycentric);
    ShadingPoint at;
    at.triangle = triangle;
    at.material = world.triangle_material[triangle];
    Material const& m = world.materials[at.material];
    if (has_textures(m)) interpolate_uv(world, s);
    vec3 const p0 = world.positions[s.vertex.x], p1 = world.positions[s.vertex.y],
               p2 = world.positions[s.vertex.z];
    at.position = p0 + barycentric.x * (p1 - p0) + barycentric.y * (p2 - p0);
    vec3 const winding_normal = triangle_normal(p0, p1, p2);
    at.front = glm::dot(direction, winding_normal) < 0;
    at.geometric_normal = at.front ? winding_normal : -winding_normal;

    vec3 n = winding_normal;
    bool bent = false;
    if (!world.normals.empty()) {
        vec3 const smooth = s.interpolate(world.normals);
        float const length = glm::length(smooth);
        if (length > 1e-6f) {
            n = smooth / length;
            bent = true;
        }
    }
    if (m.normal_map.texture >= 0) {
        n = apply_normal_map(world, s, m, n);
        bent = true;
    }
    if (bent) {
        if (glm::dot(n, at.geometric_normal) < 0) n = -n;
        n = face_viewer(n, -direction);
    } else {
        n = at.geometric_normal;
    }
    at.frame = Frame::about(n);

    at.bsdf = make_bsdf(m, look_up_factors(world, m, s));
    vec3 const reflected = at.bsdf.model == MaterialModel::phong ? at.bsdf.phong_specular : at.bsdf.f0;
    at.albedo = glm::min(at.bsdf.diffuse + reflected + at.bsdf.transmitted, vec3{1});
    at.emission = emits(m) && (at.front || m.double_sided) ? look_up_emission(world, m, s) : vec3{0};
    return at;
}

GI_FN inline float coverage(WorldView const& world, std::uint32_t triangle, vec2 barycentric)
{
    using namespace shading_detail;
    Material const& m = world.materials[world.triangle_material[triangle]];
    if (m.alpha_mode == AlphaMode::opaque) return 1;
    float alpha = m.alpha;
    if (m.base_color_map.texture >= 0) {
        SurfacePoint s = surface_point(world, triangle, barycentric);
        interpolate_uv(world, s);
        alpha *= look_up(world.textures, m.base_color_map, s.uv0, s.uv1).w;
    }
    if (m.alpha_mode == AlphaMode::mask) return alpha >= m.alpha_cutoff ? 1.0f : 0.0f;
    return glm::clamp(alpha, 0.0f, 1.0f);
}

} // namespace gi
