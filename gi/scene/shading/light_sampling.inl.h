#pragma once
// Implementation of light_sampling.h.

#include "gi/scene/shading/shading_point.h"
#include "gi/scene/shading/warp.h"

namespace gi {
namespace light_detail {

/// KHR_lights_punctual: inverse square, windowed where the light has a range.
GI_FN inline float distance_attenuation(Light const& light, float distance)
{
    float const inverse_square = 1 / (distance * distance);
    if (!(light.range > 0)) return inverse_square;
    float const window = 1 - square(square(distance / light.range));
    return window > 0 ? glm::min(window, 1.0f) * inverse_square : 0.0f;
}

/// KHR_lights_punctual: smooth between the two cones.
GI_FN inline float cone_attenuation(Light const& light, float cos_angle)
{
    float const width = glm::max(light.cos_inner - light.cos_outer, 1e-3f);
    return square(glm::clamp((cos_angle - light.cos_outer) / width, 0.0f, 1.0f));
}

GI_FN inline LightSample sample_punctual(Light const& light, vec3 point)
{
    LightSample s;
    s.delta = true;
    if (light.type == LightType::directional) {
        s.direction = -light.direction;
        s.distance = kInf;
        s.radiance = light.intensity;
        s.pdf = 1;
        return s;
    }
    vec3 const way = light.position - point;
    s.distance = glm::length(way);
    if (!(s.distance > 0)) return s;
    s.direction = way / s.distance;
    float factor = distance_attenuation(light, s.distance);
    if (light.type == LightType::spot) factor *= cone_attenuation(light, -glm::dot(s.direction, light.direction));
    if (!(factor > 0)) return s;
    s.radiance = light.intensity * factor;
    s.pdf = 1;
    return s;
}

/// Twice the area vector of a triangle.
GI_FN inline vec3 area_vector(Surface const& surface) { return glm::cross(surface.edge1, surface.edge2); }

GI_FN inline LightSample sample_emitter(WorldView const& world, std::uint32_t triangle, vec3 point, vec2 u)
{
    LightSample s;
    Surface const& surface = world.surfaces[triangle];
    shading_detail::SurfacePoint on{surface, square_to_triangle(u)};
    vec3 const way = on.position() - point;
    float const squared = glm::dot(way, way);
    if (!(squared > 0)) return s;
    s.distance = std::sqrt(squared);
    s.direction = way * (1 / s.distance);
    float const facing = -glm::dot(area_vector(surface), s.direction); // 2 * area * cos at the light
    if (!(facing > 0) && !surface.is(Surface::kDoubleSided)) return s;
    s.pdf = 2 * squared / std::abs(facing);
    if (!(s.pdf < kInf)) return {};
    Material const& m = world.materials[surface.material];
    if (m.emissive_map.texture >= 0) shading_detail::interpolate_uv(world, on);
    s.radiance = shading_detail::look_up_emission(world, m, on);
    // Scaled by coverage, because exact rays pass through the light's cut-out parts.
    if (m.alpha_mode != AlphaMode::opaque) s.radiance *= coverage(world, triangle, on.barycentric);
    return s;
}

/// Transforms a direction from the world to the map's own frame.
GI_FN inline vec3 to_map(WorldView const& world, vec3 d)
{
    float const c = world.environment_cos, s = world.environment_sin;
    return {c * d.x - s * d.z, d.y, s * d.x + c * d.z};
}

GI_FN inline vec3 from_map(WorldView const& world, vec3 d)
{
    float const c = world.environment_cos, s = world.environment_sin;
    return {c * d.x + s * d.z, d.y, -s * d.x + c * d.z};
}

struct MapPoint {
    vec2 position;   ///< texels, (0, 0) the top left corner
    float sin_theta; ///< from +Y
};

GI_FN inline MapPoint map_point(WorldView const& world, vec3 direction)
{
    vec3 const d = to_map(world, direction);
    float const sin_theta = std::sqrt(d.x * d.x + d.z * d.z);
    float const u = 0.5f + std::atan2(d.x, -d.z) * (0.5f * kInvPi);
    float const v = std::atan2(sin_theta, d.y) * kInvPi;
    return {{u * float(world.environment_width), v * float(world.environment_height)}, sin_theta};
}

/// Density per solid angle with which sample_environment draws a point of the map, over all texels:
/// it chooses a texel by its mean luminance times its solid angle (at the texel centre),
/// and the point in the texel by the luminance there.
/// @param texel_row, sin_theta of the point
GI_FN inline float map_pdf(WorldView const& world, float luminance_there, std::uint32_t texel_row, float sin_theta)
{
    float const middle = std::sin((float(texel_row) + 0.5f) * (kPi / float(world.environment_height)));
    return luminance_there * world.environment_pdf_per_luminance * middle / sin_theta;
}

/// Samples [0, 1) with a density proportional to a piecewise linear function: the mean of `before` and `middle` at
/// 0, `middle` at 1/2, and the mean of `middle` and `after` at 1.
GI_FN inline float sample_hats(float before, float middle, float after, float u)
{
    float const first = 0.5f * (before + middle), last = 0.5f * (middle + after);
    float const left = first + middle, right = middle + last; // areas, times four
    float const all = left + right;
    if (!(all > 0)) return u;
    bool const in_left = u * all < left;
    float const from = in_left ? first : middle, to = in_left ? middle : last;
    float const v = in_left ? u * all / left : (u * all - left) / right;
    float const root = std::sqrt(from * from + v * (to * to - from * from));
    float const t = from + root > 0 ? v * (from + to) / (from + root) : v;
    return glm::min(0.5f * ((in_left ? 0.0f : 1.0f) + t), 0x1.fffffep-1f);
}

/// Bilinear lookup, wrapped in u and clamped in v.
GI_FN inline vec3 map_radiance(WorldView const& world, vec2 position)
{
    TexelPair const u =
        texel_pair(position.x / float(world.environment_width), world.environment_width, Wrap::repeat, false);
    TexelPair const v =
        texel_pair(position.y / float(world.environment_height), world.environment_height, Wrap::clamp, false);
    auto const texel = [&](std::uint32_t x, std::uint32_t y) {
        return world.environment_radiance[std::uint64_t(y) * world.environment_width + x];
    };
    vec3 const top = glm::mix(texel(u.first, v.first), texel(u.second, v.first), u.weight);
    vec3 const bottom = glm::mix(texel(u.first, v.second), texel(u.second, v.second), u.weight);
    return world.environment_scale * glm::mix(top, bottom, v.weight);
}

/// Samples a point in a texel by the luminance of the bilinear map, so that a small sun has
/// equal weight wherever it is sampled.
GI_FN inline vec2 sample_texel(WorldView const& world, std::uint32_t x, std::uint32_t y, vec2 u)
{
    std::uint32_t const w = world.environment_width, h = world.environment_height;
    std::uint32_t const columns[3] = {x > 0 ? x - 1 : w - 1, x, x + 1 < w ? x + 1 : 0};
    std::uint32_t const rows[3] = {y > 0 ? y - 1 : 0, y, glm::min(y + 1, h - 1)};
    float l[3][3], mean[3]; // mean of each column over the height of the texel
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r)
            l[r][c] = luminance(world.environment_radiance[std::uint64_t(rows[r]) * w + columns[c]] *
                                world.environment_scale);
        mean[c] = 0.125f * l[0][c] + 0.75f * l[1][c] + 0.125f * l[2][c];
    }
    vec2 at;
    at.x = sample_hats(mean[0], mean[1], mean[2], u.x);
    int const beside = at.x < 0.5f ? 0 : 2;
    float const share = std::abs(at.x - 0.5f);
    auto const along = [&](int r) { return l[r][1] + share * (l[r][beside] - l[r][1]); };
    at.y = sample_hats(along(0), along(1), along(2), u.y);
    return at;
}

/// @param p probability of the environment among the lights
GI_FN inline LightSample sample_environment(WorldView const& world, std::uint32_t texel, float p, vec2 u)
{
    LightSample s;
    std::uint32_t const x = texel % world.environment_width, y = texel / world.environment_width;
    vec2 const position = vec2{float(x), float(y)} + sample_texel(world, x, y, u);
    float const phi = (position.x / float(world.environment_width) - 0.5f) * 2 * kPi;
    float const theta = position.y / float(world.environment_height) * kPi;
    float const sin_theta = std::sin(theta);
    if (!(sin_theta > 0)) return s;
    s.direction = from_map(world, {sin_theta * std::sin(phi), std::cos(theta), -sin_theta * std::cos(phi)});
    s.distance = kInf;
    s.radiance = map_radiance(world, position);
    s.pdf = p * map_pdf(world, luminance(s.radiance), y, sin_theta);
    return s;
}

GI_FN inline bool is_environment(WorldView const& world, LightChoice choice)
{
    return choice.light >= world.lights.size() + world.emitters.size();
}

} // namespace light_detail

GI_FN inline LightChoice choose_light(WorldView const& world, double u)
{
    LightChoice c;
    if (world.light_select.empty()) return c;
    c.light = world.light_select.sample(u);
    c.probability = world.light_select.probability(c.light);
    if (!light_detail::is_environment(world, c)) return c;
    c.texel = world.environment_select.sample(u);
    c.probability *= world.environment_select.probability(c.texel);
    return c;
}

GI_FN inline LightSample sample_light(WorldView const& world, LightChoice choice, vec3 point, vec2 u)
{
    using namespace light_detail;
    if (!(choice.probability > 0)) return {};
    if (is_environment(world, choice)) return sample_environment(world, choice.texel, world.environment_pdf, u);
    LightSample s = choice.light < world.lights.size()
                        ? sample_punctual(world.lights[choice.light], point)
                        : sample_emitter(world, world.emitters[choice.light - world.lights.size()], point, u);
    s.pdf *= choice.probability;
    return s;
}

GI_FN inline float emitter_direction_pdf(WorldView const& world, std::uint32_t triangle, float distance_m,
                                         float cos_light)
{
    if (world.emitter_pdf.empty() || !(cos_light > 0)) return 0;
    float const doubled_area = glm::length(light_detail::area_vector(world.surfaces[triangle]));
    if (!(doubled_area > 0)) return 0;
    return world.emitter_pdf[triangle] * 2 * distance_m * distance_m / (doubled_area * cos_light);
}

GI_FN inline float environment_direction_pdf(WorldView const& world, vec3 direction)
{
    using namespace light_detail;
    if (world.environment_select.empty()) return 0;
    MapPoint const at = map_point(world, direction);
    if (!(at.sin_theta > 0)) return 0;
    std::uint32_t const y = glm::min(std::uint32_t(at.position.y), world.environment_height - 1);
    return world.environment_pdf * map_pdf(world, luminance(map_radiance(world, at.position)), y, at.sin_theta);
}

GI_FN inline vec3 environment_radiance(WorldView const& world, vec3 direction)
{
    if (world.environment_radiance.empty()) return vec3{0};
    return light_detail::map_radiance(world, light_detail::map_point(world, direction).position);
}

GI_FN inline vec3 background_radiance(WorldView const& world, vec3 direction)
{
    if (world.background.kind == BackgroundKind::map) return environment_radiance(world, direction);
    return world.background.kind == BackgroundKind::color ? world.background.color : vec3{0};
}

} // namespace gi
