#pragma once
// A grid of cubic cells over the scene, and quantities of those of its cells that are not empty.

#include "gi/core/math.h"
#include "gi/core/view.h"

#include <cstdint>
#include <vector>

namespace gi {

struct GridFrame {
    vec3 low{0};        ///< corner of cell (0, 0, 0), m
    float cell = 1;     ///< side, m
    glm::ivec3 size{0}; ///< cells per axis

    std::size_t cells() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
    GI_FN bool holds(glm::ivec3 c) const
    {
        return c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x < size.x && c.y < size.y && c.z < size.z;
    }
    GI_FN std::uint32_t index(glm::ivec3 c) const { return std::uint32_t((c.z * size.y + c.y) * size.x + c.x); }
    GI_FN glm::ivec3 cell_of(std::uint32_t index) const
    {
        int const i = int(index);
        return {i % size.x, i / size.x % size.y, i / size.x / size.y};
    }
    /// The cell of a point; may lie outside of the grid. @param p  finite
    GI_FN glm::ivec3 at(vec3 p) const { return glm::ivec3(glm::floor(glm::clamp((p - low) / cell, -1.0f, 1e6f))); }
    GI_FN vec3 center(glm::ivec3 c) const { return low + cell * (vec3(c) + 0.5f); }
};

/// The part of a ray in a box from 0 to `end`, in any unit of length.
struct GridRay {
    vec3 from;      ///< where it enters the box, or the origin in it
    vec3 direction; ///< unit
    vec3 inverse;   ///< of the direction, finite
    float skipped;  ///< from the origin to `from`
    float length;   ///< from there to where it leaves; not above 0 = the ray misses the box

    /// @param origin  relative to the box's corner  @param start  nearer parts are skipped
    GI_FN GridRay(vec3 origin, vec3 direction_, vec3 end, float start) : direction(direction_)
    {
        for (int axis = 0; axis < 3; ++axis) {
            float const d = direction[axis];
            inverse[axis] = 1 / (glm::abs(d) < 1e-9f ? (d < 0 ? -1e-9f : 1e-9f) : d);
        }
        vec3 const to_low = -origin * inverse, to_high = (end - origin) * inverse;
        skipped = glm::max(max_component(glm::min(to_low, to_high)), start);
        length = min_component(glm::max(to_low, to_high)) - skipped;
        from = origin + skipped * direction;
    }
    /// Where it leaves a cube, from `from`. @param corner  the low one
    GI_FN float leaves(vec3 corner, float side) const
    {
        return min_component(glm::max((corner - from) * inverse, (corner + side - from) * inverse));
    }
};

inline constexpr std::uint32_t kNoCell = 0xffffffffu;

/// Values of some cells, to read.
template <class T>
struct CellsView {
    GridFrame frame;
    View<std::uint32_t const> place; ///< per cell: index into `values`, or kNoCell
    View<T const> values;

    GI_FN std::uint32_t find_place(glm::ivec3 c) const { return frame.holds(c) ? place[frame.index(c)] : kNoCell; }
    GI_FN T const* find(glm::ivec3 c) const
    {
        std::uint32_t const p = find_place(c);
        return p == kNoCell ? nullptr : &values[p];
    }
};

/// Values of some cells.
template <class T>
struct SparseCells {
    GridFrame frame;
    std::vector<std::uint32_t> place; ///< per cell: index into `values`, or kNoCell
    std::vector<std::uint32_t> cells; ///< per value: its cell
    std::vector<T> values;

    explicit SparseCells(GridFrame const& f = {}) : frame(f), place(f.cells(), kNoCell) {}
    CellsView<T> view() const { return {frame, place, values}; }
    /// Index of the cell's value, of a new one if it has none. @param c  in the grid
    std::uint32_t place_at(glm::ivec3 c)
    {
        std::uint32_t& p = place[frame.index(c)];
        if (p == kNoCell) {
            p = std::uint32_t(values.size());
            cells.push_back(frame.index(c));
            values.emplace_back();
        }
        return p;
    }
    T& at(glm::ivec3 c) { return values[place_at(c)]; }
};

} // namespace gi
