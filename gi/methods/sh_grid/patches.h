#pragma once
// The surfaces of a cell in patches: triangles that touch each other and face the same way. The two sides of a
// thin wall are different patches, and so is what lies behind it.

#include "gi/methods/sh_grid/voxels.h"

#include <span>

namespace gi {

/// Quantities of surfaces by the six directions along the axes of a grid: -x, +x, -y, +y, -z, +z.
template <class T>
struct AxisBins {
    T bin[6] = {};

    GI_FN AxisBins& operator+=(AxisBins const& o)
    {
        for (int k = 0; k < 6; ++k) bin[k] += o.bin[k];
        return *this;
    }
    GI_FN T largest() const
    {
        T most = bin[0];
        for (int k = 1; k < 6; ++k) most = bin[k] > most ? bin[k] : most;
        return most;
    }
    /// Divides a value among the three bins that a direction points to, by the squares of its components.
    /// @param direction  unit
    GI_FN void add(vec3 direction, T const& value)
    {
        for (int axis = 0; axis < 3; ++axis)
            bin[2 * axis + (direction[axis] > 0 ? 1 : 0)] += square(direction[axis]) * value;
    }
};

/// The bin that a direction points to most.
GI_FN inline std::uint32_t main_axis(vec3 d)
{
    vec3 const a = glm::abs(d);
    int const axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return std::uint32_t(2 * axis + (d[axis] > 0 ? 1 : 0));
}

/// To find patches by cells. Those of a cell follow each other.
struct PatchTableView {
    View<std::uint32_t const> first_entry; ///< per cell, in the order of the grid's values, and one more
    View<std::uint32_t const> triangles;   ///< of entries, ascending in each cell
    View<std::uint32_t const> patches;     ///< of entries

    /// The patch of a triangle in a cell, or kNoCell. @param place  of the cell's value
    GI_FN std::uint32_t find(std::uint32_t place, std::uint32_t triangle) const
    {
        if (std::size_t(place) + 1 >= first_entry.size()) return kNoCell;
        std::uint32_t low = first_entry[place], high = first_entry[place + 1];
        std::uint32_t const end = high;
        while (low < high) {
            std::uint32_t const middle = (low + high) / 2;
            if (triangles[middle] < triangle)
                low = middle + 1;
            else
                high = middle;
        }
        return low < end && triangles[low] == triangle ? patches[low] : kNoCell;
    }
};

struct PatchTable {
    std::vector<std::uint32_t> first_entry, triangles, patches; ///< see PatchTableView
    std::vector<std::uint32_t> first_patch;                     ///< per cell, and one more

    PatchTableView view() const { return {first_entry, triangles, patches}; }
};

struct PatchesView {
    PatchTableView fixed, moving;
    std::uint32_t first_moving; ///< triangle
    GI_FN std::uint32_t find(std::uint32_t place, std::uint32_t triangle) const
    {
        return (triangle < first_moving ? fixed : moving).find(place, triangle);
    }
};

/// Patches of triangles that stay, numbered from 0, and after them those of triangles that can move.
struct Patches {
    PatchTable fixed, moving;
    std::uint32_t first_moving = 0;           ///< triangle
    std::vector<std::uint32_t> cell_of_patch; ///< index of its value
    std::vector<BlockVoxels> voxels;          ///< of its cell, in which each patch has pieces

    PatchesView view() const { return {fixed.view(), moving.view(), first_moving}; }
    std::size_t count() const { return cell_of_patch.size(); }
};

/// Patches of the pieces in a grid, numbered from all.count(). Those of less than a twentieth of a cell's face are
/// joined with the others of their cell that face the same way: else single photons would make them glare.
/// @param all  cells and voxels of theirs are appended  @param of_piece  overwritten: the patch of each piece
PatchTable find_patches(World const& world, VoxelGrid const& grid, Patches& all,
                        std::vector<std::uint32_t>& of_piece);

/// The patch that a point on a triangle belongs to, also where rounding moved
/// the point to the next cell, or kNoCell.
GI_FN inline std::uint32_t patch_at(CellsView<BlockVoxels> const& blocks, PatchesView const& patches, vec3 point,
                                    std::uint32_t triangle)
{
    for (int k = -1; k < 6; ++k) {
        vec3 p = point;
        if (k >= 0) p[k / 2] += (k % 2 == 0 ? -1e-3f : 1e-3f) * blocks.frame.cell;
        std::uint32_t const place = blocks.find_place(blocks.frame.at(p));
        std::uint32_t const patch = place == kNoCell ? kNoCell : patches.find(place, triangle);
        if (patch != kNoCell) return patch;
    }
    return kNoCell;
}

} // namespace gi
