#pragma once
#include "gi/scene/model/scene.h"

namespace gi {

/// Returns a clear sky without the sun (which is a directional light): blue above, pale at the horizon, brighter
/// towards the sun, and sunlit ground below. @param to_sun unit
EnvironmentMap generate_sky(vec3 to_sun);

} // namespace gi
