#pragma once
// Light sampling for next-event estimation: a light is chosen by power (alias table over punctual lights,
// emissive triangles and the environment), then a point or direction on it.

#include "gi/scene/model/world.h"

namespace gi {

struct LightSample {
    vec3 direction{0};  ///< unit, from the point towards the light
    float distance = 0; ///< m; kInf for directional lights and the environment
    vec3 radiance{0};   ///< radiance for area light and environment; for delta lights the irradiance across the
                        ///< beam (intensity / d^2). Contribution = f * cos * radiance / pdf
    float pdf = 0;      ///< 1/sr times selection probability; delta lights: selection probability. 0 = no sample
    bool delta = false;
};

/// A chosen light or environment texel. Independent of the lit point, so it can be chosen in advance.
struct LightChoice {
    std::uint32_t light = 0; ///< index into World::light_select
    std::uint32_t texel = 0; ///< of the environment map, if that is the light
    float probability = 0;   ///< of light and texel together; 0 = there is no light
};

/// @param u uniform in [0, 1), all 53 bits of it
GI_FN LightChoice choose_light(WorldView const& world, double u);
/// @param u uniform in [0, 1)^2
GI_FN LightSample sample_light(WorldView const& world, LightChoice choice, vec3 point, vec2 u);
/// Probability density with which sample_light draws the direction to a point on an emissive triangle.
/// @param distance_m to that point, cos_light = |cos| between the triangle's normal and the direction
GI_FN float emitter_direction_pdf(WorldView const& world, std::uint32_t triangle, float distance_m,
                                  float cos_light);
/// Probability density with which sample_light draws a direction to the environment.
GI_FN float environment_direction_pdf(WorldView const& world, vec3 direction);
/// Radiance from the environment (bilinear), 0 if there is none.
GI_FN vec3 environment_radiance(WorldView const& world, vec3 direction);
/// Radiance of a camera ray that hits no surface.
GI_FN vec3 background_radiance(WorldView const& world, vec3 direction);

} // namespace gi

#include "gi/scene/shading/light_sampling.inl.h"
