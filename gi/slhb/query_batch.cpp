#include "gi/slhb/query_batch.h"

#include "gi/raster/lanes.h"

#include <algorithm>
#include <bit>

namespace gi {
namespace {

using namespace lanes;
using Pairs = hn::Repartition<std::int64_t, Integers>;
using HalfIntegers = hn::Half<Integers>;

struct TwoWords {
    W first, second;
};

/// Records of two words at index * 2^kStrideLog2 bytes: one load of 64 bits a lane instead of two of 32.
template <int kStrideLog2>
TwoWords gather_pairs(void const* base, I index)
{
    Words const words;
    Pairs const pairs;
    HalfIntegers const half;
    auto const* const from = static_cast<std::int64_t const*>(base);
    auto const offset = [&](auto part) { return hn::ShiftLeft<kStrideLog2>(hn::PromoteTo(pairs, part)); };
    auto const low = hn::BitCast(words, hn::GatherOffset(pairs, from, offset(hn::LowerHalf(half, index))));
    auto const high = hn::BitCast(words, hn::GatherOffset(pairs, from, offset(hn::UpperHalf(half, index))));
    return {hn::ConcatEven(words, high, low), hn::ConcatOdd(words, high, low)};
}

/// The numbers of a grid, the same in all lanes or each lane's own.
struct GridLanes {
    V right[3], up[3], axis[3], corner_x, corner_y, texel, per_texel, last_i, last_j, width, rounding;
    I first_offset, first_layer;
    V low, step; ///< of packed depths
};

GridLanes same_grid(AxisPool const& pool, std::size_t a)
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

GridLanes own_grids(AxisPool const& pool, std::uint32_t const* axes)
{
    Floats const d;
    Integers const integers;
    // Beyond the last query of a batch there may be anything.
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

/// Texel coordinates (whole numbers) of the column that is asked at an attempt: the nearest centre; then across
/// the nearer border of its texel, across the other, and across both.
struct Cell {
    V i, j;
};

Cell choose_cell(V x, V y, GridLanes const& g, int attempt)
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

struct Answer {
    std::uint32_t unsure;   ///< bit per lane: its column does not speak for its origin
    std::uint32_t doubtful; ///< bit per lane: it does if the surface can be hit from there
};

/// Which columns a block of queries looks into. Found for the whole block before any is walked, so that the cache
/// misses of all of them overlap.
struct Columns {
    static constexpr std::size_t kBlock = 16 * kMostLanes;

    alignas(64) float i[kBlock];
    alignas(64) float j[kBlock];
    alignas(64) std::int32_t texel[kBlock];       ///< into the pool's offsets
    alignas(64) std::int32_t first_layer[kBlock]; ///< of the axis
};

void find_columns(GridLanes const& g, int attempt, QueryBatch const& b, std::size_t first, std::size_t at,
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

/// Worth it where queries walk along many axes, whose buffers lie in no cache.
void fetch(AxisPool const& pool, Columns const& columns, QueryBatch const& b, std::size_t first, std::size_t n)
{
    for (std::size_t k = 0; k < n; ++k) __builtin_prefetch(&pool.offset[std::size_t(columns.texel[k])]);
    for (std::size_t k = 0; k < n; ++k) {
        auto const t = std::size_t(columns.texel[k]);
        bool const up = (b.triangle[first + k] & kWalkUp) != 0;
        __builtin_prefetch(pool.layers.data() + std::size_t(columns.first_layer[k]) +
                           pool.offset[t + (up ? 0 : 1)] - (up ? 0 : 1));
    }
}

struct LayerLanes {
    V depth;
    W primitive; ///< with its facing
};

template <bool kPacked>
LayerLanes load_layers(AxisPool const& pool, GridLanes const& g, I index)
{
    Floats const d;
    Words const words;
    if constexpr (kPacked) {
        Integers const integers;
        W const word = hn::BitCast(
            words, hn::GatherIndex(integers, reinterpret_cast<std::int32_t const*>(pool.packed.data()), index));
        V const step = hn::ConvertTo(d, hn::BitCast(integers, hn::ShiftRight<20>(word)));
        W const facing = hn::And(hn::ShiftLeft<12>(word), hn::Set(words, kAlongAxis));
        return {hn::MulAdd(step, g.step, g.low),
                hn::Or(facing, hn::And(word, hn::Set(words, kPackedTriangles - 1)))};
    } else {
        TwoWords const record = gather_pairs<3>(pool.layers.data(), index);
        return {hn::BitCast(d, record.first), record.second};
    }
}

/// One vector of queries; query_detail::look_into in lanes.
template <bool kPacked>
Answer answer_vector(AxisPool const& pool, GridLanes const& g, int attempt, QueryBatch& b, std::size_t first,
                     Columns const& columns, std::size_t column)
{
    Floats const d;
    Words const words;
    Integers const integers;
    auto const set = [&](float v) { return hn::Set(d, v); };
    V const x = hn::LoadU(d, b.x.data() + first), y = hn::LoadU(d, b.y.data() + first),
            z = hn::LoadU(d, b.z.data() + first);
    auto const along = [&](V const* to) { return hn::MulAdd(z, to[2], hn::MulAdd(y, to[1], hn::Mul(x, to[0]))); };
    Cell const cell{hn::Load(d, columns.i + column), hn::Load(d, columns.j + column)};
    I const texel = hn::Load(integers, columns.texel + column);
    TwoWords const range = gather_pairs<2>(pool.offset.data(), texel);
    I const begin = hn::BitCast(integers, range.first), end = hn::BitCast(integers, range.second);

    W const primitive = hn::LoadU(words, b.triangle.data() + first);
    W const own = hn::And(primitive, hn::Set(words, kPrimitiveMask));
    W const facing_bit = hn::Set(words, kAlongAxis);
    W const own_facing = hn::And(primitive, facing_bit);
    Mask const is_up = hn::RebindMask(d, hn::TestBit(primitive, hn::Set(words, kWalkUp)));
    // Layers that face the walk have this facing.
    W const towards = hn::IfThenElseZero(hn::Not(hn::RebindMask(words, is_up)), facing_bit);
    V const sign = hn::IfThenElse(is_up, set(1), set(-1));
    V const origin = hn::Mul(sign, along(g.axis));
    V const margin = hn::Mul(g.texel, hn::Add(set(1), hn::LoadU(d, b.slope.data() + first)));

    I const one = hn::Set(integers, 1), zero = hn::Zero(integers);
    I const step = hn::ConvertTo(integers, sign);
    I at = hn::Add(g.first_layer, hn::IfThenElse(hn::RebindMask(integers, is_up), begin, hn::Sub(end, one)));
    I left = hn::Sub(end, begin);
    V best = margin, own_depth = hn::Zero(d), depth = hn::Zero(d), gap = hn::Zero(d), plain_depth = hn::Zero(d);
    Mask found = hn::FirstN(d, 0), hit = found, plain_hit = found;
    W answer = hn::Set(words, kNoLayerHit), plain = answer;
    I answer_at = zero, plain_at = zero;
    for (Mask running = hn::RebindMask(d, hn::Gt(left, zero)); !hn::AllFalse(d, running);) {
        // Not by `running`: so the next layers can be under way while these are judged.
        LayerLanes const record = load_layers<kPacked>(pool, g, hn::IfThenElseZero(hn::Gt(left, zero), at));
        V const layer_depth = record.depth;
        W const layer = record.primitive, facing = hn::And(layer, facing_bit);
        V const from_origin = hn::MulSub(sign, layer_depth, origin), distance = hn::Abs(from_origin);
        Mask const same = hn::RebindMask(d, hn::Eq(hn::And(layer, hn::Set(words, kPrimitiveMask)), own));
        Mask const alike = hn::And(hn::RebindMask(d, hn::Eq(facing, own_facing)), hn::Le(distance, best));
        Mask const is_own = hn::And(running, hn::Or(same, alike));
        best = hn::IfThenElse(is_own, hn::IfThenElse(same, set(-1), distance), best);
        own_depth = hn::IfThenElse(is_own, from_origin, own_depth);
        found = hn::Or(found, is_own);
        hit = hn::AndNot(is_own, hit);
        Mask const other = hn::AndNot(is_own, running);
        V const beyond = hn::Sub(from_origin, own_depth);
        Mask const new_hit = hn::And(hn::AndNot(hit, hn::And(other, found)), hn::Gt(beyond, g.rounding));
        hit = hn::Or(hit, new_hit);
        depth = hn::IfThenElse(new_hit, layer_depth, depth);
        gap = hn::IfThenElse(new_hit, beyond, gap);
        answer = hn::IfThenElse(hn::RebindMask(words, new_hit), layer, answer);
        answer_at = hn::IfThenElse(hn::RebindMask(integers, new_hit), at, answer_at);
        if (attempt == 0) {
            Mask const faces = hn::RebindMask(d, hn::Eq(facing, towards));
            Mask const new_plain =
                hn::And(hn::AndNot(plain_hit, hn::And(other, faces)), hn::Gt(from_origin, g.rounding));
            plain_hit = hn::Or(plain_hit, new_plain);
            plain_depth = hn::IfThenElse(new_plain, layer_depth, plain_depth);
            plain = hn::IfThenElse(hn::RebindMask(words, new_plain), layer, plain);
            plain_at = hn::IfThenElse(hn::RebindMask(integers, new_plain), at, plain_at);
        }
        Mask const answered = hn::Or(hn::And(found, hit), hn::AndNot(found, plain_hit));
        Mask const over = hn::And(answered, hn::Or(hn::Lt(best, hn::Zero(d)), hn::Gt(from_origin, margin)));
        at = hn::Add(at, step);
        left = hn::Sub(left, one);
        running = hn::AndNot(over, hn::And(running, hn::RebindMask(d, hn::Gt(left, zero))));
    }
    Mask const front = hn::RebindMask(d, hn::Eq(hn::And(answer, facing_bit), towards));
    Mask const doubtful =
        hn::And(hn::And(found, hit), hn::Or(hn::Not(front), hn::Lt(gap, hn::Mul(set(4), g.texel))));
    depth = hn::IfThenElse(found, depth, plain_depth);
    answer =
        hn::IfThenElse(hn::RebindMask(words, found),
                       hn::IfThenElse(hn::RebindMask(words, hit), answer, hn::Set(words, kNoLayerHit)), plain);
    V const u = hn::MulAdd(hn::Add(cell.i, set(0.5f)), g.texel, g.corner_x);
    V const v = hn::MulAdd(hn::Add(cell.j, set(0.5f)), g.texel, g.corner_y);
    auto const store = [&](std::size_t k, std::vector<float>& to) {
        hn::StoreU(hn::MulAdd(depth, g.axis[k], hn::MulAdd(v, g.up[k], hn::Mul(u, g.right[k]))), d,
                   to.data() + first);
    };
    store(0, b.hit_x);
    store(1, b.hit_y);
    store(2, b.hit_z);
    hn::StoreU(answer, words, b.hit.data() + first);
    hn::StoreU(hn::BitCast(words, hn::IfThenElse(hn::RebindMask(integers, found), answer_at, plain_at)), words,
               b.hit_layer.data() + first);
    return {bits_of(hn::Not(found)), bits_of(doubtful)};
}

/// Rounded up to whole vectors, which the arrays are made for.
std::size_t padded(std::size_t n) { return (n + kMostLanes - 1) / kMostLanes * kMostLanes; }

void copy_query(QueryBatch const& from, std::size_t i, QueryBatch& to, std::size_t k)
{
    to.x[k] = from.x[i];
    to.y[k] = from.y[i];
    to.z[k] = from.z[i];
    to.triangle[k] = from.triangle[i];
    to.slope[k] = from.slope[i];
    to.axis[k] = from.axis[i];
}

struct ManyGrids {
    static constexpr bool kMany = true;
    AxisPool const& pool;
    std::uint32_t const* axes;

    ManyGrids(AxisPool const& p, std::size_t, QueryBatch const& b) : pool(p), axes(b.axis.data()) {}
    GridLanes operator()(std::size_t i) const { return own_grids(pool, axes + i); }
    RasterGrid const& of(std::size_t i) const { return pool.grids[axes[i]]; }
};

struct OneGrid {
    static constexpr bool kMany = false;
    GridLanes grid;
    RasterGrid const& plain;

    OneGrid(AxisPool const& p, std::size_t a, QueryBatch const&) : grid(same_grid(p, a)), plain(p.grids[a]) {}
    GridLanes const& operator()(std::size_t) const { return grid; }
    RasterGrid const& of(std::size_t) const { return plain; }
};

/// Of a query that has no good answer yet: twice its index, and 1 if its column has an own layer.
constexpr std::uint32_t kHasOwn = 1;

/// Asks all queries of the batch at one attempt; those that have no good answer yet go to `unsure`.
template <class Grids>
void ask(AxisPool const& pool, Grids const& grids, View<Surface const> surfaces, int attempt, QueryBatch& b,
         std::vector<std::uint32_t>& unsure)
{
    std::size_t const lanes = hn::Lanes(Floats()), n = b.size();
    unsure.clear();
    thread_local Columns columns;
    thread_local GridLanes grids_of_block[Columns::kBlock / 4]; // vectors have at least 4 lanes
    thread_local std::vector<std::uint32_t> doubtful;
    doubtful.clear();
    for (std::size_t i = 0; i < n; i += lanes) {
        std::size_t const column = i % Columns::kBlock;
        if (column == 0) {
            std::size_t const block = std::min(Columns::kBlock, n - i);
            for (std::size_t k = 0; k < block; k += lanes) {
                grids_of_block[k / lanes] = grids(i + k);
                find_columns(grids_of_block[k / lanes], attempt, b, i + k, k, columns);
            }
            if constexpr (Grids::kMany) fetch(pool, columns, b, i, block);
        }
        auto const answer_lanes = pool.packed.empty() ? answer_vector<false> : answer_vector<true>;
        Answer answer = answer_lanes(pool, grids_of_block[column / lanes], attempt, b, i, columns, column);
        if (n - i < lanes) {
            std::uint32_t const there = (1u << (n - i)) - 1;
            answer = {answer.unsure & there, answer.doubtful & there};
        }
        for (std::uint32_t bits = answer.doubtful; bits != 0; bits &= bits - 1) {
            std::uint32_t const q = std::uint32_t(i) + std::uint32_t(std::countr_zero(bits));
            __builtin_prefetch(&surfaces[b.hit[q] & kPrimitiveMask]);
            doubtful.push_back(q);
        }
        for (std::uint32_t bits = answer.unsure; bits != 0; bits &= bits - 1)
            unsure.push_back(2 * (std::uint32_t(i) + std::uint32_t(std::countr_zero(bits))));
        if (column + lanes < Columns::kBlock && i + lanes < n) continue;
        for (std::uint32_t const q : doubtful) // their surfaces have come meanwhile
            if (!query_detail::can_be_hit(surfaces[b.hit[q] & kPrimitiveMask], b.hit[q], b.origin(q),
                                          grids.of(q)))
                unsure.push_back(2 * q + kHasOwn);
        doubtful.clear();
    }
    std::ranges::sort(unsure);
}

template <class Grids>
void answer_all(AxisPool const& pool, std::size_t a, View<Surface const> surfaces, QueryBatch& b)
{
    thread_local std::vector<std::uint32_t> waiting, unsure;
    thread_local QueryBatch again;
    b.resize(b.size());
    ask(pool, Grids(pool, a, b), surfaces, 0, b, waiting);
    for (int attempt = 1; attempt < 4 && !waiting.empty(); ++attempt) {
        again.resize(waiting.size());
        for (std::size_t k = 0; k < waiting.size(); ++k) copy_query(b, waiting[k] / 2, again, k);
        ask(pool, Grids(pool, a, again), surfaces, attempt, again, unsure);
        std::size_t left = 0, next = 0;
        for (std::uint32_t k = 0; k < waiting.size(); ++k) {
            std::uint32_t const i = waiting[k] / 2;
            if (next < unsure.size() && unsure[next] / 2 == k) {
                // The first answer of a column with an own layer stands, if there is no good one.
                bool const stands = (waiting[k] & kHasOwn) != 0 || (unsure[next] & kHasOwn) == 0;
                waiting[left++] = waiting[k] | (unsure[next++] & kHasOwn);
                if (stands) continue;
            }
            b.hit[i] = again.hit[k];
            b.hit_layer[i] = again.hit_layer[k];
            b.hit_x[i] = again.hit_x[k];
            b.hit_y[i] = again.hit_y[k];
            b.hit_z[i] = again.hit_z[k];
        }
        waiting.resize(left);
    }
}

} // namespace

void QueryBatch::resize(std::size_t n)
{
    for (auto* a : {&x, &y, &z, &slope, &hit_x, &hit_y, &hit_z}) {
        a->reserve(padded(n));
        a->resize(n);
    }
    for (auto* a : {&triangle, &axis, &hit, &hit_layer}) {
        a->reserve(padded(n));
        a->resize(n);
    }
}

void QueryBatch::set(std::size_t i, WalkOrigin const& o, std::uint32_t along_axis)
{
    x[i] = o.position.x;
    y[i] = o.position.y;
    z[i] = o.position.z;
    triangle[i] = o.triangle | (o.along ? kAlongAxis : 0) | (o.up ? kWalkUp : 0);
    slope[i] = o.slope;
    axis[i] = along_axis;
}

void nearest_layers(AxisPool const& pool, View<Surface const> surfaces, QueryBatch& batch)
{
    answer_all<ManyGrids>(pool, 0, surfaces, batch);
}

void nearest_layers(AxisPool const& pool, std::size_t a, View<Surface const> surfaces, QueryBatch& batch)
{
    answer_all<OneGrid>(pool, a, surfaces, batch);
}

} // namespace gi
