#pragma once
// Exact rays from cells of the field.

#include "gi/methods/sh_grid/field.h"
#include "gi/render/exact_visibility.h"

#include <span>

namespace gi {

/// A grid whose patches rays meet.
struct FieldTarget {
    CellsView<BlockVoxels> blocks;
    PatchesView patches;
};

/// Traces all directions from the centres of some cells. At mirrors and glass a ray goes on by
/// one of their directions, chosen at random by its weight, and light from there gets their tint;
/// the light of lamps is none of what they bring.
/// @param levels  grids of all levels, the finest first: a hit belongs to the first that has its patch
/// @param frame  of `cells`  @param hits  per cell, by direction
void trace_field_rays(World const& world, ExactVisibility const& visibility, std::span<FieldTarget const> levels,
                      GridFrame const& frame, std::span<FieldDirection const> directions,
                      std::span<std::uint32_t const> cells, std::span<FieldHit> hits);

} // namespace gi
