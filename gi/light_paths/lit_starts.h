#pragma once
// Light paths that begin on lit surfaces: a surface point, a light sample, a shadow ray between the two.
// So surfaces are reached however small their share of the lights' power is.

#include "gi/core/alias_table.h"
#include "gi/light_paths/light_paths.h"

namespace gi {

/// Triangles, and the chance of each.
struct StartTargets {
    std::vector<std::uint32_t> triangles;
    AliasTable choice; ///< empty = there are none
};

struct LitStarts {
    std::vector<LightStart> starts;
    std::vector<std::uint32_t> targets; ///< of each of them
};

enum class StartLights : std::uint8_t {
    all,
    lamps ///< without extent: point, spot and directional ones
};

LitStarts start_on_surfaces(WorldView const& world, ExactVisibility const& visibility, StartTargets const& targets,
                            LightPathSet const& set, BuildStop const& stop, PathCounts& counts,
                            StartLights lights = StartLights::all);

/// Sets the probabilities of the targets: half of the paths then begin in proportion to the light that earlier
/// paths brought there. Later paths must use other random numbers than those, or the result is biased.
/// @param light  per target. Returns false if there is none.
bool learn_chances(std::span<float const> light, StartTargets& targets);

} // namespace gi
