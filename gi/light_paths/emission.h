#pragma once
// Sampling of light leaving the lights: the counterpart of light_sampling.h, for CPU and CUDA.

#include "gi/scene/model/camera.h"
#include "gi/scene/shading/light_sampling.h"
#include "gi/scene/shading/shading_point.h"
#include "gi/scene/shading/warp.h"

namespace gi {

/// Start of one light path. The expectation of `power` over choices and samples is the power of all lights, W per
/// channel; for the sky and parallel lights this is the power that falls on the scene's bounding sphere.
struct EmittedLight {
    Ray ray;
    vec3 power{0};   ///< 0 = no light
    float range = 0; ///< m, of a punctual light (see Light); 0 = unlimited
    /// Area and solid angle over which samples of this light are spread about this one, m^2 and sr.
    float area = 0, solid_angle = 0;
    std::uint32_t triangle = 0xffffffffu; ///< the triangle that emits it; 0xffffffff = none
};

namespace emission_detail {

/// Parallel light through a disk as wide as the scene. @param travels  unit
GI_FN inline EmittedLight through_scene(Bounds const& bounds, vec3 travels, vec3 irradiance, vec2 place)
{
    constexpr float kAround = 1.001f; // so that rounding does not exclude a corner
    float const radius = kAround * bounds.radius();
    Frame const frame = Frame::about(travels);
    vec2 const on_disk = radius * square_to_disk(place);
    vec3 const from = bounds.center() - radius * travels + on_disk.x * frame.tangent + on_disk.y * frame.bitangent;
    float const area = kPi * radius * radius;
    return {{from, travels}, irradiance * area, 0, area, 0};
}

GI_FN inline EmittedLight emit_punctual(Light const& light, Bounds const& bounds, vec2 place, vec2 direction)
{
    if (light.type == LightType::directional)
        return through_scene(bounds, light.direction, light.intensity, place);
    float const lowest = light.type == LightType::spot ? light.cos_outer : -1.0f;
    float const z = 1 - direction.x * (1 - lowest), r = std::sqrt(glm::max(0.0f, 1 - z * z));
    vec2 const turn = azimuth(direction.y);
    vec3 const local{r * turn.x, r * turn.y, z};
    vec3 power = light.intensity * (2 * kPi * (1 - lowest));
    if (light.type == LightType::spot) power *= light_detail::cone_attenuation(light, z);
    vec3 const about = light.type == LightType::spot ? light.direction : vec3{0, 0, 1};
    return {{light.position, Frame::about(about).to_world(local)}, power, light.range, 0, 2 * kPi * (1 - lowest)};
}

GI_FN inline EmittedLight emit_triangle(WorldView const& world, std::uint32_t triangle, vec2 place, vec2 direction,
                                        float side)
{
    Surface const& surface = world.surfaces[triangle];
    shading_detail::SurfacePoint on{surface, square_to_triangle(place)};
    Material const& m = world.materials[surface.material];
    if (m.emissive_map.texture >= 0) shading_detail::interpolate_uv(world, on);
    vec3 radiance = shading_detail::look_up_emission(world, m, on);
    if (m.alpha_mode != AlphaMode::opaque) radiance *= coverage(world, triangle, on.barycentric);
    bool const both = surface.is(Surface::kDoubleSided);
    vec3 const normal = shading_detail::triangle_normal(surface) * (both && side < 0.5f ? -1.0f : 1.0f);
    float const area = 0.5f * glm::length(light_detail::area_vector(surface));
    vec3 const local = square_to_cosine_hemisphere(direction);
    float const sides = both ? 2.0f : 1.0f;
    return {{on.position() + surface.clearance * normal, Frame::about(normal).to_world(local)},
            radiance * (kPi * area * sides),
            0,
            sides * area,
            sides * kPi / glm::max(local.z, 1e-3f),
            triangle};
}

} // namespace emission_detail

/// True for the sky and for parallel lights.
GI_FN inline bool comes_from_afar(WorldView const& world, LightChoice choice)
{
    return light_detail::is_environment(world, choice) ||
           (choice.light < world.lights.size() && world.lights[choice.light].type == LightType::directional);
}

/// @param choice  from choose_light  @param bounds  of the world  @param place, direction  uniform in [0, 1)^2
/// @param side  uniform in [0, 1): selects the face of a double-sided light
GI_FN inline EmittedLight emit_light(WorldView const& world, LightChoice choice, Bounds const& bounds, vec2 place,
                                     vec2 direction, float side)
{
    if (!(choice.probability > 0) || bounds.empty()) return {};
    if (light_detail::is_environment(world, choice)) {
        LightSample const s = sample_light(world, choice, bounds.center(), direction);
        if (!(s.pdf > 0)) return {};
        return emission_detail::through_scene(bounds, -s.direction, s.radiance / s.pdf, place);
    }
    std::size_t const lights = world.lights.size();
    EmittedLight e =
        choice.light < lights
            ? emission_detail::emit_punctual(world.lights[choice.light], bounds, place, direction)
            : emission_detail::emit_triangle(world, world.emitters[choice.light - lights], place, direction, side);
    e.power /= choice.probability;
    return e;
}

} // namespace gi
