#pragma once
// Sampling of light leaving the lights: the counterpart of light_sampling.h.

#include "gi/scene/model/camera.h"
#include "gi/scene/shading/light_sampling.h"

namespace gi {

/// Start of one light path. The expectation of `power` over choices and samples is the power of all lights, W per
/// channel; for the sky and parallel lights this is the power that falls on the scene's bounding sphere.
struct EmittedLight {
    Ray ray;
    vec3 power{0};   ///< 0 = no light
    float range = 0; ///< m, of a punctual light (see Light); 0 = unlimited
    /// Area and solid angle over which samples of this light are spread about this one, m^2 and sr.
    float area = 0, solid_angle = 0;
};

/// True for the sky and for parallel lights.
bool comes_from_afar(WorldView const& world, LightChoice choice);

/// @param choice  from choose_light  @param bounds  of the world  @param place, direction  uniform in [0, 1)^2
/// @param side  uniform in [0, 1): selects the face of a double-sided light
EmittedLight emit_light(WorldView const& world, LightChoice choice, Bounds const& bounds, vec2 place,
                        vec2 direction, float side);

} // namespace gi
