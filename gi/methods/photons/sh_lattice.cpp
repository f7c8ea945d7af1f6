#include "gi/methods/photons/sh_lattice.h"

#include "gi/kernel/launch.h"
#include "gi/methods/photons/lattice_kernels.h"

#include <algorithm>
#include <numeric>

namespace gi {

std::vector<GridFrame> nested_frames(Bounds const& bounds, vec3 center, int cells, int cascades, int border)
{
    vec3 const extent = bounds.high - bounds.low;
    float const longest = std::max(max_component(extent), 1e-5f * (1 + max_component(glm::abs(bounds.center()))));
    float const coarsest = longest / float(cells - 1 - 2 * border); // the box does not begin with a cell
    std::vector<GridFrame> out;
    for (int cascade = 0; cascade < cascades; ++cascade) {
        GridFrame f;
        f.cell = std::ldexp(coarsest, cascade + 1 - cascades);
        for (int axis = 0; axis < 3; ++axis) {
            // In cells from the world's origin.
            double const side = double(f.cell);
            double const low = std::floor(double(bounds.low[axis]) / side) - border,
                         high = std::ceil(double(bounds.high[axis]) / side) + border;
            f.size[axis] = int(std::min(high - low, double(cells)));
            double const wanted = std::floor(double(center[axis]) / side) - f.size[axis] / 2;
            f.low[axis] = float(std::clamp(wanted, low, high - f.size[axis]) * side);
        }
        out.push_back(f);
    }
    return out;
}

std::vector<GridFrame> frames_off_walls(Bounds const& bounds, vec3 center, int cells, int cascades)
{
    float const about = max_component(bounds.high - bounds.low) / float(cells);
    vec3 const shift = bounds.low - about * vec3{0.37f, 0.41f, 0.43f};
    std::vector<GridFrame> frames =
        nested_frames({bounds.low - shift, bounds.high - shift}, center - shift, cells, cascades, 0);
    for (GridFrame& f : frames) f.low += shift;
    return frames;
}

int nested_cascades(Bounds const& bounds, Bounds const& focus, int most)
{
    if (bounds.empty() || focus.empty()) return 1;
    float const whole = max_component(bounds.high - bounds.low), part = max_component(focus.high - focus.low);
    int cascades = 1;
    while (cascades < most && std::ldexp(whole, -cascades) >= part) ++cascades;
    return cascades;
}

std::uint64_t dense_bytes(std::span<GridFrame const> frames, std::size_t cell_bytes)
{
    std::uint64_t sum = 0;
    for (GridFrame const& f : frames) sum += f.cells() * cell_bytes;
    return sum;
}

std::uint64_t sparse_bytes(GridFrame const& frame, double area_m2, std::size_t cell_bytes)
{
    // A plane through a grid meets up to three cells per face's area, and parts of cells at its edges.
    double const met = 3 * area_m2 / (double(frame.cell) * double(frame.cell)) + 1000;
    double const filled = std::min(met, double(frame.cells()));
    return frame.cells() * sizeof(std::uint32_t) + std::uint64_t(filled) * (cell_bytes + sizeof(std::uint32_t));
}

ItemsByCell sort_by_cell(std::vector<std::uint64_t>& keys, std::size_t cells)
{
    std::size_t const n = keys.size();
    ItemsByCell out{std::vector<std::uint32_t>(n), std::vector<std::uint32_t>(cells + 1)};
    std::iota(out.order.begin(), out.order.end(), 0u);
    std::vector<std::uint64_t> scratch_keys(n);
    std::vector<std::uint32_t> scratch_order(n);
    sort_pairs(Space::host, keys, out.order, scratch_keys, scratch_order);
    launch(Space::host, "find first items of cells", cells + 1, FindFirstItems{keys, out.firsts});
    return out;
}

} // namespace gi
