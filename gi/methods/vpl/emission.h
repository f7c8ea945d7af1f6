#pragma once
// Light as it leaves the lamps: the other end of light_sampling.h.

#include "gi/scene/model/camera.h"
#include "gi/scene/shading/light_sampling.h"

namespace gi {

/// One light path at its lamp. The expectation of `power` over choices and samples is the power of all lamps, W
/// per channel; that of the sky and of parallel light is what falls on the scene's bounding sphere.
struct EmittedLight {
    Ray ray;
    vec3 power{0};   ///< 0 = nothing leaves
    float range = 0; ///< m, of a punctual light (see Light); 0 = unlimited
};

/// @param choice from choose_light  @param bounds of the world  @param place, direction  uniform in [0, 1)^2
/// @param side  uniform in [0, 1): which face of a double-sided lamp
EmittedLight emit_light(WorldView const& world, LightChoice choice, Bounds const& bounds, vec2 place,
                        vec2 direction, float side);

} // namespace gi
