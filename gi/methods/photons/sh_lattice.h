#pragma once
// Lattices: grids of cells that hold light as spherical harmonics, dense or only where there is something, and the
// steps that all of them share: sums of items by their cells, smoothing, trilinear look-ups, nested grids.
//
// A cell type has operator+= and float * cell. Memory: dense, 48 bytes a ShColor and cell; sparse, 4 bytes a cell
// of the grid and its value where there is something.

#include "gi/kernel/sort.h"
#include "gi/methods/photons/sh_color.h"
#include "gi/methods/sh_grid/grid.h"
#include "gi/scene/model/world.h"

#include <span>

namespace gi {

template <class Cell>
struct DenseView {
    GridFrame frame;
    View<Cell const> values; ///< frame.cells(), or none

    GI_FN Cell const* find(glm::ivec3 c) const
    {
        return frame.holds(c) && !values.empty() ? &values[frame.index(c)] : nullptr;
    }
};

/// Sum of the eight cells around a point by trilinear weights; what is not stored adds nothing. Lattice: DenseView
/// or CellsView of Cell.
template <class Cell, class Lattice>
GI_FN Cell trilinear(Lattice const& in, vec3 position)
{
    vec3 const at = glm::clamp((position - in.frame.low) / in.frame.cell - 0.5f, -2.0f, 1e6f),
               low = glm::floor(at), part = at - low;
    Cell sum{};
    for (int k = 0; k < 8; ++k) {
        glm::ivec3 const corner{k & 1, k >> 1 & 1, k >> 2};
        Cell const* const cell = in.find(glm::ivec3(low) + corner);
        if (cell == nullptr) continue;
        float weight = 1;
        for (int axis = 0; axis < 3; ++axis) weight *= corner[axis] != 0 ? part[axis] : 1 - part[axis];
        sum += weight * *cell;
    }
    return sum;
}

inline bool same(GridFrame const& a, GridFrame const& b)
{
    return a.low == b.low && a.cell == b.cell && a.size == b.size;
}

/// Weight of a nested grid at a point: 1 inside, 0 outside and in the outer half of its border cells,
/// linear over a cell in between.
GI_FN inline float weight_in(GridFrame const& frame, vec3 position)
{
    vec3 const at = (position - frame.low) / frame.cell;
    return glm::clamp(min_component(glm::min(at, vec3(frame.size) - at)) - 0.5f, 0.0f, 1.0f);
}

/// Calls of(index, weight) for the grids that hold a point, finest first; the coarsest takes what is left.
template <class Frames, class Function>
void for_grids_at(Frames const& grids, vec3 position, Function const& of)
{
    float left = 1;
    for (std::size_t k = 0; k < grids.size() && left > 0; ++k) {
        float const weight = k + 1 == grids.size() ? left : left * weight_in(grids[k].frame, position);
        if (weight > 0) of(k, weight);
        left -= weight;
    }
}

/// Nested grids around a point, the finest first; the last one holds the whole box and a border, the cells of each
/// other one are half as wide as the next one's. All are placed by whole cells from the world's origin, so that
/// light does not swim when the point moves; they stay in the last one.
/// @param cells  along the longest side, at least 2 + 2 border  @param border  cells beyond the box
/// @param cascades  at least 1  @param bounds  not empty
std::vector<GridFrame> nested_frames(Bounds const& bounds, vec3 center, int cells, int cascades, int border = 1);

/// The same without a border, and so placed, relative to the box, that walls along the axes do not lie between two
/// cells: for light that is kept where surfaces are.
std::vector<GridFrame> frames_off_walls(Bounds const& bounds, vec3 center, int cells, int cascades);

/// Number of nested grids about the centre of a focus of which the finest just holds it,
/// at most `most`; 1 if it is empty.
int nested_cascades(Bounds const& bounds, Bounds const& focus, int most);
/// The centre of a focus, or a point if it is empty.
inline vec3 center_of(Bounds const& focus, vec3 otherwise) { return focus.empty() ? otherwise : focus.center(); }

/// Bytes of dense lattices of `cell_bytes` a cell over grids.
std::uint64_t dense_bytes(std::span<GridFrame const> frames, std::size_t cell_bytes);
/// Upper bound of the bytes of a sparse lattice whose surfaces have a total area. @param area_m2  of a side
std::uint64_t sparse_bytes(GridFrame const& frame, double area_m2, std::size_t cell_bytes);

/// Items in the order of their cells; within a cell in their own order, so that sums do not depend on threads.
struct ItemsByCell {
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> firsts; ///< per cell in `order`, and one more: items in no cell follow
};
/// @param keys  the cell of each item, cells or more = none; overwritten
ItemsByCell sort_by_cell(std::vector<std::uint64_t>& keys, std::size_t cells);

} // namespace gi
