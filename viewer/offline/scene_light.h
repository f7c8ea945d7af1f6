#pragma once
// The light of scenes that bring none, as models made for rasterising viewers do: without it they would be black.

#include "gi/scene/model/scene.h"

#include <array>
#include <string>
#include <string_view>

namespace viewer {

/// What is done with a scene without light: automatic and studio add studio_light() before a grey background, white adds
/// a sky of radiance 1, none leaves it dark. Studio and white replace the environment map of a scene that has one.
inline constexpr std::array<std::string_view, 4> kLightChoices{"auto", "studio", "white", "none"};

/// A room for photographs, in light grey: a large soft lamp at the front, above and to the right (front: +Z), a weaker one at
/// the left, a rim light behind, a darker floor. A white diffuse surface that faces most light sends radiance 1.
gi::EnvironmentMap studio_light();

/// Adds light as chosen (one of kLightChoices). Returns what was added and why, a sentence; empty = nothing.
/// Emission by a texture of at most radiance 1 glows, as lamps and screens of such models do, but is not taken for a light.
std::string add_light(gi::Scene& scene, std::string_view choice);

} // namespace viewer
