#pragma once
// The light of scenes that bring none, as models made for rasterising viewers do: without it they would be black.

#include "gi/scene/model/scene.h"

#include <array>
#include <string>
#include <string_view>

namespace viewer {

/// What a scene without light gets: studio_light() before a grey background, a sky of radiance 1, or nothing. Scenes with light
/// are not touched. For the first, emission by a texture of at most radiance 1 is no light, as models glow so;
/// and scenes of unlit materials alone get the sky of radiance 1, before the same background: they show their base colours.
inline constexpr std::array<std::string_view, 3> kLightChoices{"studio", "white", "none"};

/// A room for photographs, in light grey: a large soft lamp at the front, above and to the right (front: +Z), a weaker one at
/// the left, a rim light behind, a darker floor. A white diffuse surface that faces most light sends radiance 1.
gi::EnvironmentMap studio_light();

/// Adds light as chosen (one of kLightChoices). Returns what was added and why, a sentence; empty = nothing.
std::string add_light(gi::Scene& scene, std::string_view choice);

} // namespace viewer
