#pragma once
// Where the surfaces are: a fine grid of voxels (the paper's V-grid), stored in blocks of
// 4 x 4 x 4 that are the cells of the coarser grids (SH-grid and R-grid; Chang, Park and Ihm, sec. 3.1).
// Blocks without surfaces are not stored.

#include "gi/core/progress.h"
#include "gi/methods/sh_grid/grid.h"
#include "gi/render/render_settings.h"
#include "gi/scene/model/world.h"

namespace gi {

/// Bit x + 4 y + 16 z: that voxel of the block holds a part of a surface.
using BlockVoxels = std::uint64_t;

/// The part of a triangle in one voxel.
struct SurfacePiece {
    std::uint32_t block; ///< index of its value in VoxelGrid::blocks
    std::uint32_t triangle;
    std::uint8_t voxel; ///< of the block: x + 4 y + 16 z
    vec3 point;         ///< its centroid, m, from the world's origin
    vec3 normal;        ///< unit, geometric, of the side from which the triangle is counter-clockwise
    float area;         ///< m^2
};

struct VoxelGrid {
    SparseCells<BlockVoxels> blocks;
    std::vector<SurfacePiece> pieces; ///< of area above 0, in the order of the triangles

    float voxel_m() const { return blocks.frame.cell / 4; }
};

/// Number of voxels with surfaces.
std::uint64_t count_voxels(SparseCells<BlockVoxels> const& blocks);

/// An empty grid over a box, with some room around it. @param voxels  along the longest side, at least 8
/// @param bounds  not empty, m. Throws InputError above ShGridSettings::kMostVoxels.
VoxelGrid empty_voxel_grid(Bounds const& bounds, int voxels);

/// Adds triangles first to last - 1. Conservative: marks every voxel that a triangle overlaps or touches, and none
/// that is 1e-3 voxels or more away. Leaves out triangles that have no area, are not
/// finite, lie beyond kFarthest, or are pure mirrors or glass (rays pass these). Throws Interrupted.
void add_triangles(World const& world, std::size_t first, std::size_t last, VoxelGrid& grid,
                   BuildStop const& stop = BuildStop(nullptr));

/// A ray's first voxel with a surface.
struct GridHit {
    glm::ivec3 block{0};
    float distance = -1; ///< m, to where the ray enters the voxel; below 0 = none
};

/// Walks through the blocks, and in those with surfaces through the voxels (sec. 3.4.2).
/// @param start  where the walk begins, m along the ray  @param direction  unit
GI_FN inline GridHit walk_grid(CellsView<BlockVoxels> const& blocks, vec3 origin, vec3 direction, float start)
{
    GridFrame const& frame = blocks.frame;
    float const voxel = frame.cell / 4;
    constexpr float kStep = 1e-3f; // past borders, voxels
    GridRay const ray((origin - frame.low) / voxel, direction, vec3(4 * frame.size), start / voxel);
    for (float t = kStep; t < ray.length - kStep;) {
        vec3 const p = ray.from + t * direction;
        glm::ivec3 const v = glm::clamp(glm::ivec3(glm::floor(p)), glm::ivec3{0}, 4 * frame.size - 1);
        std::uint32_t const place = blocks.place[frame.index(v / 4)];
        float side = 4;
        if (place != kNoCell) {
            glm::ivec3 const in = v % 4;
            if ((blocks.values[place] >> (in.x + 4 * in.y + 16 * in.z) & 1) != 0)
                return {v / 4, (ray.skipped + t) * voxel};
            side = 1;
        }
        t = glm::max(ray.leaves(glm::floor(p / side) * side, side), t) + kStep;
    }
    return {};
}

} // namespace gi
