#pragma once
// Finds the columns that the look-ups of a batch use, vector by vector, and prefetches their memory before they
// are walked. For query_batch.cpp only: the arrays are as wide as the SIMD vectors of its compilation target.

#include "gi/hit_buffers/query_batch.h"
#include "gi/raster/lanes.h"

#include <algorithm>
#include <cstring>

namespace gi::query_lanes {

using namespace lanes;

/// Parameters of a grid, the same in all lanes or different per lane.
struct GridLanes {
    V right[3], up[3], axis[3], corner_x, corner_y, texel, per_texel, last_i, last_j, width, rounding;
    I first_offset, first_layer;
    V low, step; ///< of packed depths
};

inline GridLanes same_grid(AxisPool const& pool, std::size_t a)
{
    RasterGrid const& g = pool.grids[a];
    Floats const d;
    Integers const integers;
    auto const set = [&](float v) { return hn::Set(d, v); };
    return {{set(g.right.x), set(g.right.y), set(g.right.z)},
            {set(g.up.x), set(g.up.y), set(g.up.z)},
            {set(g.axis.x), set(g.axis.y), set(g.axis.z)},
            set(g.corner.x),
            set(g.corner.y),
            set(g.texel),
            set(1 / g.texel),
            set(float(g.width) - 1),
            set(float(g.height) - 1),
            set(float(g.width)),
            set(g.rounding),
            hn::Set(integers, std::int32_t(pool.first_offset[a])),
            hn::Set(integers, std::int32_t(pool.first_layer[a])),
            set(pool.packed.empty() ? 0 : pool.packed_low[a]),
            set(pool.packed.empty() ? 0 : pool.packed_step[a])};
}

inline GridLanes own_grids(AxisPool const& pool, std::uint32_t const* axes)
{
    Floats const d;
    Integers const integers;
    // Beyond the last look-up of a batch, axis indices may be arbitrary.
    W const most = hn::Set(Words(), std::uint32_t(pool.size() - 1));
    I const a = hn::BitCast(integers, hn::Min(hn::LoadU(Words(), axes), most));
    I const at = hn::Mul(a, hn::Set(integers, std::int32_t(sizeof(RasterGrid) / sizeof(float))));
    static_assert(sizeof(RasterGrid) % sizeof(float) == 0);
    RasterGrid const& g = pool.grids[0];
    auto const real = [&](float const& member) { return hn::GatherIndex(d, &member, at); };
    auto const whole = [&](std::uint32_t const& member) {
        return hn::ConvertTo(d, hn::GatherIndex(integers, reinterpret_cast<std::int32_t const*>(&member), at));
    };
    auto const of_axis = [&](std::vector<std::uint32_t> const& v) {
        return hn::GatherIndex(integers, reinterpret_cast<std::int32_t const*>(v.data()), a);
    };
    V const one = hn::Set(d, 1), texel = real(g.texel), width = whole(g.width);
    return {{real(g.right.x), real(g.right.y), real(g.right.z)},
            {real(g.up.x), real(g.up.y), real(g.up.z)},
            {real(g.axis.x), real(g.axis.y), real(g.axis.z)},
            real(g.corner.x),
            real(g.corner.y),
            texel,
            hn::Div(one, texel),
            hn::Sub(width, one),
            hn::Sub(whole(g.height), one),
            width,
            real(g.rounding),
            of_axis(pool.first_offset),
            of_axis(pool.first_layer),
            pool.packed.empty() ? hn::Zero(d) : hn::GatherIndex(d, pool.packed_low.data(), a),
            pool.packed.empty() ? hn::Zero(d) : hn::GatherIndex(d, pool.packed_step.data(), a)};
}

/// Texel coordinates (whole numbers) of the column used by an attempt: the nearest centre; then across the nearer
/// border of its texel, across the other, and across both.
struct Cell {
    V i, j;
};

inline Cell choose_cell(V x, V y, GridLanes const& g, int attempt)
{
    Floats const d;
    V const zero = hn::Zero(d), one = hn::Set(d, 1), half = hn::Set(d, 0.5f);
    Cell const c{hn::Max(hn::Min(hn::Floor(x), g.last_i), zero), hn::Max(hn::Min(hn::Floor(y), g.last_j), zero)};
    if (attempt == 0) return c;
    V const off_x = hn::Sub(x, hn::Add(c.i, half)), off_y = hn::Sub(y, hn::Add(c.j, half));
    auto const other = [&](V at, V off, V last) {
        V const next = hn::Add(at, hn::IfThenElse(hn::Lt(off, zero), hn::Set(d, -1), one));
        return hn::IfThenElse(hn::Or(hn::Lt(next, zero), hn::Gt(next, last)), at, next);
    };
    V const i = other(c.i, off_x, g.last_i), j = other(c.j, off_y, g.last_j);
    if (attempt == 3) return {i, j};
    Mask const x_first = hn::Gt(hn::Abs(off_x), hn::Abs(off_y));
    Mask const to_x = attempt == 1 ? x_first : hn::Not(x_first);
    return {hn::IfThenElse(to_x, i, c.i), hn::IfThenElse(to_x, c.j, j)};
}

/// Columns used by look-ups. They are found for pairs of vectors ahead of the one being walked, so that cache
/// misses overlap with other look-ups.
struct Columns {
    static constexpr std::size_t kPairs = 8, kRing = 2 * kPairs * kMostLanes; ///< ring buffer of the newest pairs
    static constexpr std::size_t kAhead = 4, kLayersAhead = 2;                ///< pairs; of offsets, of layers

    alignas(64) float i[kRing];
    alignas(64) float j[kRing];
    alignas(64) std::int32_t texel[kRing];       ///< into the pool's offsets
    alignas(64) std::int32_t first_layer[kRing]; ///< of the axis
    alignas(64) std::int32_t begin[kRing];       ///< layers of the column, relative to the axis' first
    alignas(64) std::int32_t end[kRing];
    alignas(64) std::uint8_t moved[kRing]; ///< the column contains dynamic geometry
};

inline void find_columns(GridLanes const& g, int attempt, QueryBatch const& b, std::size_t first, std::size_t at,
                         Columns& columns)
{
    Floats const d;
    Integers const integers;
    V const x = hn::LoadU(d, b.x.data() + first), y = hn::LoadU(d, b.y.data() + first),
            z = hn::LoadU(d, b.z.data() + first);
    auto const along = [&](V const* to) { return hn::MulAdd(z, to[2], hn::MulAdd(y, to[1], hn::Mul(x, to[0]))); };
    Cell const cell = choose_cell(hn::Mul(hn::Sub(along(g.right), g.corner_x), g.per_texel),
                                  hn::Mul(hn::Sub(along(g.up), g.corner_y), g.per_texel), g, attempt);
    I const texel = hn::Add(hn::ConvertTo(integers, hn::MulAdd(cell.j, g.width, cell.i)), g.first_offset);
    hn::Store(cell.i, d, columns.i + at);
    hn::Store(cell.j, d, columns.j + at);
    hn::Store(texel, integers, columns.texel + at);
    hn::Store(g.first_layer, integers, columns.first_layer + at);
}

/// Fetching in two steps pays off if the buffers are not in the cache.
inline void fetch_offsets(AxisPool const& pool, Columns const& columns, std::size_t column, std::size_t n)
{
    if (pool.by_ranges()) {
        for (std::size_t k = column; k < column + n; ++k) __builtin_prefetch(&pool.ranges[columns.texel[k]]);
        return;
    }
    for (std::size_t k = column; k < column + n; ++k) {
        std::uint32_t const* const offset = pool.offset.data() + columns.texel[k];
        __builtin_prefetch(offset);
        __builtin_prefetch(offset + 1); // often in the next cache line for one lane, for which all would wait
    }
}

/// Uses plain loads: gathers that miss in the TLB were measured to be far slower.
inline void find_ranges(AxisPool const& pool, Columns& columns, std::size_t column, std::size_t n)
{
    for (std::size_t k = column; k < column + n; ++k) {
        LayerRange const range = pool.column(std::size_t(columns.texel[k]));
        columns.begin[k] = std::int32_t(range.begin);
        columns.end[k] = std::int32_t(range.end);
        columns.moved[k] = std::uint32_t(columns.first_layer[k]) + range.begin >= pool.first_moved;
    }
}

template <class Record>
void fetch_layers(std::vector<Record> const& layers, Columns const& columns, std::size_t column, std::size_t n)
{
    for (std::size_t k = column; k < column + n; ++k) {
        Record const* const first = layers.data() + columns.first_layer[k];
        __builtin_prefetch(first + columns.begin[k]);
        __builtin_prefetch(first + columns.end[k] - 1);
    }
}

/// Called after the prefetch, so that address translations are in the TLB for the gather.
template <class Record>
void touch_layers(std::vector<Record> const& layers, Columns const& columns, std::size_t column, std::size_t n)
{
    std::int32_t const last = std::int32_t(layers.size()) - 1;
    std::uint32_t sum = 0;
    for (std::size_t k = column; k < column + n; ++k) {
        std::uint32_t word;
        std::memcpy(&word, layers.data() + std::min(columns.first_layer[k] + columns.begin[k], last),
                    sizeof(word));
        sum += word;
    }
    asm volatile("" : : "r"(sum));
}

} // namespace gi::query_lanes
