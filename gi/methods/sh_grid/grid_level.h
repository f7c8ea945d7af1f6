#pragma once
// What sh_grid keeps of one grid: where surfaces are, which of them light can reach,
// their radiance, and the field.

#include "gi/methods/sh_grid/field.h"

namespace gi {

struct GridLevel {
    Bounds bounds;
    SparseCells<BlockVoxels> fixed_blocks; ///< of triangles that stay
    SparseCells<BlockVoxels> blocks;       ///< of all, first those of the former
    Patches patches;
    std::vector<PatchSample> samples; ///< of patches that stay, then of others
    std::size_t fixed_patches = 0, fixed_samples = 0;
    std::vector<ReachedSides> reached; ///< by part of the light paths
    RadianceGrids grids;
    Field field;
    std::vector<std::uint32_t> new_cells; ///< indices of those without a value yet
    double hidden_m2 = 0;                 ///< area that no light can reach, of both sides
};

/// A level with the triangles before first_moving. Throws Interrupted.
GridLevel make_grid_level(World const& world, std::size_t first_moving, Bounds const& bounds, int voxels,
                          ExactVisibility const& visibility, BuildStop const& stop);

/// Brings triangles from patches.first_moving on up to date. Throws Interrupted.
void find_moving_surfaces(World const& world, ExactVisibility const& visibility, BuildStop const& stop,
                          GridLevel& level);

/// Brings the radiance grids up to date. @param photons  where surfaces are now
void make_radiance_grid(std::span<ReflectedPhoton const> photons, bool sky_shines, RadianceBy by,
                        GridLevel& level);

} // namespace gi
