#include "gi/methods/sh_grid/grid_level.h"

namespace gi {

GridLevel make_grid_level(World const& world, std::size_t first_moving, Bounds const& bounds, int voxels,
                          ExactVisibility const& visibility, BuildStop const& stop)
{
    GridLevel level;
    level.bounds = bounds;
    VoxelGrid grid = empty_voxel_grid(bounds, voxels);
    add_triangles(world, 0, first_moving, grid, stop);
    std::vector<std::uint32_t> patch_of;
    level.patches.first_moving = std::uint32_t(first_moving);
    level.patches.fixed = find_patches(world, grid, level.patches, patch_of);
    choose_samples(grid.pieces, patch_of, level.samples);
    look_around(world, visibility, grid.blocks.frame, RayWorld::what_stays, stop, level.samples);
    level.fixed_patches = level.patches.count();
    level.fixed_samples = level.samples.size();
    level.fixed_blocks = level.blocks = std::move(grid.blocks);
    return level;
}

void find_moving_surfaces(World const& world, ExactVisibility const& visibility, BuildStop const& stop,
                          GridLevel& level)
{
    VoxelGrid grid{level.fixed_blocks, {}};
    add_triangles(world, level.patches.first_moving, world.triangles.size(), grid, stop);
    level.patches.cell_of_patch.resize(level.fixed_patches);
    level.patches.voxels.resize(level.fixed_patches);
    level.samples.resize(level.fixed_samples);
    std::vector<std::uint32_t> patch_of;
    level.patches.moving = find_patches(world, grid, level.patches, patch_of);
    choose_samples(grid.pieces, patch_of, level.samples);
    look_around(world, visibility, grid.blocks.frame, RayWorld::all, stop,
                std::span(level.samples).subspan(level.fixed_samples));
    level.blocks = std::move(grid.blocks);
}

void make_radiance_grid(std::span<ReflectedPhoton const> photons, bool sky_shines, RadianceBy by, GridLevel& level)
{
    ReachedSides reached(level.blocks.frame);
    for (ReachedSides const& part : level.reached) reached |= part;
    SortedPhotons const sorted = sort_photons(level.blocks, level.patches, photons);
    ExposedAreas const areas =
        exposed_areas(level.blocks, level.patches, level.samples, reached, photons, sorted, sky_shines, by);
    level.hidden_m2 = areas.hidden_m2;
    level.grids = make_radiance_grids(level.blocks, level.patches, areas, photons, sorted, by);
}

} // namespace gi
