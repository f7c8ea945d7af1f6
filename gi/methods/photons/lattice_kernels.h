#pragma once
// Steps on lattices, as kernels for CPU and CUDA.

#include "gi/methods/photons/sh_lattice.h"

namespace gi {

/// The first of the sorted items of each cell.
struct FindFirstItems {
    View<std::uint64_t const> keys; ///< sorted
    View<std::uint32_t> firsts;     ///< one per cell and one more

    GI_FN void operator()(std::size_t cell) const
    {
        std::size_t low = 0, high = keys.size();
        while (low < high) {
            std::size_t const middle = (low + high) / 2;
            if (keys[middle] < cell)
                low = middle + 1;
            else
                high = middle;
        }
        firsts[cell] = std::uint32_t(low);
    }
};

/// Adds its items to each cell. Item: has GI_FN add_to(Cell&) const.
template <class Item, class Cell>
struct SumItems {
    View<Item const> items;
    View<std::uint32_t const> order, firsts;
    View<Cell> cells;

    GI_FN void operator()(std::size_t cell) const
    {
        Cell sum = cells[cell];
        for (std::uint32_t k = firsts[cell]; k < firsts[cell + 1]; ++k) items[order[k]].add_to(sum);
        cells[cell] = sum;
    }
};

/// Mean over 3 x 3 x 3 cells with equal weights; what is not stored counts as nothing.
template <class Cell>
struct SmoothCells {
    CellsView<Cell> in;
    View<std::uint32_t const> cells; ///< per value: its cell
    View<Cell> out;                  ///< per value

    GI_FN void operator()(std::size_t i) const
    {
        glm::ivec3 const at = in.frame.cell_of(cells[i]);
        Cell sum{};
        for (int k = 0; k < 27; ++k) {
            Cell const* const near = in.find(at + glm::ivec3{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1});
            if (near != nullptr) sum += *near;
        }
        out[i] = (1.0f / 27) * sum;
    }
};

/// One step of gathering from the six neighbours. Two cells exchange the same share of what they hold, so that the
/// sum over all cells stays.
template <class Cell>
struct GatherCells {
    static constexpr float kShare = 1.0f / 7; ///< in the middle of a volume all seven count alike

    CellsView<Cell> in;
    View<std::uint32_t const> cells; ///< per value: its cell
    View<Cell> out;                  ///< per value

    GI_FN void operator()(std::size_t i) const
    {
        glm::ivec3 const at = in.frame.cell_of(cells[i]);
        Cell sum = in.values[i];
        for (int k = 0; k < 6; ++k) {
            glm::ivec3 next = at;
            next[k / 2] += 2 * (k % 2) - 1;
            Cell const* const near = in.find(next);
            if (near == nullptr) continue;
            sum += kShare * *near;
            sum += -kShare * in.values[i];
        }
        out[i] = sum;
    }
};

} // namespace gi
