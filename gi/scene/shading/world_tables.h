#pragma once
// Tables derived from the arrays of a World, in separate parts so that a change updates no more than necessary.

#include "gi/core/report.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gi {

struct World;

/// Fills World::bsdfs from its materials.
void build_bsdfs(World& world);
/// Updates World::surfaces of the triangles first .. end - 1; the array must already have its size.
void update_surfaces(World& world, std::size_t first, std::size_t end);
/// Same for all triangles of one material.
void update_surfaces_of(World& world, std::uint32_t material);

/// Emissive triangles, in order, and the luminance of each one's power, W.
struct EmitterPowers {
    std::vector<std::uint32_t> triangles;
    std::vector<double> powers_w;
};
/// Appends the emissive triangles of first .. end - 1. Triangles without area do not emit.
void add_emitters(World const& world, std::size_t first, std::size_t end, EmitterPowers& to);
/// Fills World::environment_select.
void build_environment_table(World& world);
/// Fills World::emitters, emitter_pdf, light_select and environment_pdf from the lights, the bounds, the
/// environment table, and the static and moving emitters.
void build_light_select(World& world, EmitterPowers const& fixed, EmitterPowers const& moving);

} // namespace gi
