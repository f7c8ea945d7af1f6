#pragma once
// What is derived from the arrays of a World once they are there, in parts, so that a change renews no more than
// it must.

#include "gi/core/report.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gi {

struct World;

/// Fill World::bsdfs from its materials.
void build_bsdfs(World& world);
/// World::surfaces of the triangles first .. end - 1; the array is there.
void update_surfaces(World& world, std::size_t first, std::size_t end);
/// The same of all triangles of one material.
void update_surfaces_of(World& world, std::uint32_t material);

/// Triangles that emit, in order, and the luminance of what each sends out, W.
struct EmitterPowers {
    std::vector<std::uint32_t> triangles;
    std::vector<double> powers_w;
};
/// Append those of first .. end - 1. Triangles without area do not emit.
void add_emitters(World const& world, std::size_t first, std::size_t end, EmitterPowers& to);
/// Fill World::environment_select.
void build_environment_table(World& world);
/// Fill World::emitters, emitter_pdf, light_select and environment_pdf from the lights, the bounds, the table of
/// the environment, and emitters that stay and that move.
void build_light_select(World& world, EmitterPowers const& fixed, EmitterPowers const& moving);

} // namespace gi
