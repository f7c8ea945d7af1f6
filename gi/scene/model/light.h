#pragma once
// Punctual lights (glTF KHR_lights_punctual) as plain data in the frame of their node or of the world.
// Area lights are not listed here: any triangle whose material emits is a light.

#include "gi/core/math.h"

namespace gi {

enum class LightType : std::uint8_t { point, spot, directional };

struct Light {
    LightType type = LightType::point;
    vec3 position{0};         ///< m; not used by directional
    vec3 direction{0, 0, -1}; ///< unit, direction in which the light travels; not used by point
    vec3 intensity{1}; ///< point, spot: radiant intensity W/sr; directional: irradiance W/m2 across the beam
    float cos_inner = 1, cos_outer = 0.70710678f; ///< spot: full inside inner, zero outside outer, smooth between
    float range = 0; ///< m; 0 = unlimited. glTF's windowing: max(min(1-(d/range)^4,1),0)/d^2

    bool operator==(Light const&) const = default;
};

} // namespace gi
