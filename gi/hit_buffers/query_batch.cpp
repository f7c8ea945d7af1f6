#include "gi/hit_buffers/query_batch.h"

#include "gi/hit_buffers/query_columns.h"

#include <algorithm>
#include <bit>

namespace gi {
namespace {

using namespace query_lanes;
using Pairs = hn::Repartition<std::int64_t, Integers>;
using HalfIntegers = hn::Half<Integers>;

struct TwoWords {
    W first, second;
};

/// Records of two words at index * 2^kStrideLog2 bytes: one 64-bit load per lane instead of two 32-bit loads.
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

struct LayerLanes {
    V depth;
    W primitive; ///< with its facing bit
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

/// SIMD form of query_detail::look_into, without the result of columns that lack an own layer. Two vectors
/// advance together to hide latency, as each step depends on the previous one.
template <bool kPacked>
struct WalkLanes {
    static constexpr Floats d{};
    static constexpr Words words{};
    static constexpr Integers integers{};

    AxisPool const& pool;
    GridLanes const& g;
    W own, own_facing;
    V sign, origin, margin;
    I step, at, left, answer_at;
    V best, own_depth; ///< along the walk, relative to the origin
    Mask found = hn::FirstN(d, 0), hit = found, running;

    WalkLanes(AxisPool const& p, GridLanes const& grid, QueryBatch const& b, std::size_t first, I begin, I end)
        : pool(p), g(grid)
    {
        V const x = hn::LoadU(d, b.x.data() + first), y = hn::LoadU(d, b.y.data() + first),
                z = hn::LoadU(d, b.z.data() + first);
        W const primitive = hn::LoadU(words, b.triangle.data() + first);
        own = hn::And(primitive, hn::Set(words, kPrimitiveMask));
        own_facing = hn::And(primitive, hn::Set(words, kAlongAxis));
        Mask const is_up = hn::RebindMask(d, hn::TestBit(primitive, hn::Set(words, kWalkUp)));
        V const one = hn::Set(d, 1);
        I const one_layer = hn::Set(integers, 1);
        sign = hn::IfThenElse(is_up, one, hn::Set(d, -1));
        origin = hn::Mul(sign, hn::MulAdd(z, g.axis[2], hn::MulAdd(y, g.axis[1], hn::Mul(x, g.axis[0]))));
        margin = hn::Mul(g.texel, hn::Add(one, hn::LoadU(d, b.slope.data() + first)));
        step = hn::ConvertTo(integers, sign);
        at = hn::Add(g.first_layer,
                     hn::IfThenElse(hn::RebindMask(integers, is_up), begin, hn::Sub(end, one_layer)));
        left = hn::Sub(end, begin);
        answer_at = hn::Zero(integers);
        best = margin;
        own_depth = hn::Zero(d);
        running = hn::RebindMask(d, hn::Gt(left, hn::Zero(integers)));
    }

    void next_layer()
    {
        I const zero = hn::Zero(integers);
        // Not masked by `running`, so that the next layers can be loaded while these are tested.
        LayerLanes const layer = load_layers<kPacked>(pool, g, hn::IfThenElseZero(hn::Gt(left, zero), at));
        V const from_origin = hn::MulSub(sign, layer.depth, origin), distance = hn::Abs(from_origin);
        Mask const same = hn::RebindMask(d, hn::Eq(hn::And(layer.primitive, hn::Set(words, kPrimitiveMask)), own));
        W const facing = hn::And(layer.primitive, hn::Set(words, kAlongAxis));
        Mask const alike = hn::And(hn::RebindMask(d, hn::Eq(facing, own_facing)), hn::Le(distance, best));
        Mask const is_own = hn::And(running, hn::Or(same, alike));
        best = hn::IfThenElse(is_own, hn::IfThenElse(same, hn::Set(d, -1), distance), best);
        own_depth = hn::IfThenElse(is_own, from_origin, own_depth);
        found = hn::Or(found, is_own);
        hit = hn::AndNot(is_own, hit);
        Mask const first_beyond = hn::And(hn::AndNot(hit, hn::AndNot(is_own, running)),
                                          hn::Gt(hn::Sub(from_origin, own_depth), g.rounding));
        Mask const new_hit = hn::And(found, first_beyond);
        hit = hn::Or(hit, new_hit);
        answer_at = hn::IfThenElse(hn::RebindMask(integers, new_hit), at, answer_at);
        // No later layer can be a nearer own layer.
        Mask const past = hn::And(hn::Gt(from_origin, margin), hn::Or(hit, hn::Not(found)));
        Mask const done = hn::Or(past, hn::And(hit, hn::Lt(best, hn::Zero(d))));
        at = hn::Add(at, step);
        left = hn::Sub(left, hn::Set(integers, 1));
        running = hn::AndNot(done, hn::And(running, hn::RebindMask(d, hn::Gt(left, zero))));
    }
};

/// Bits per lane of a pair of vectors.
struct Answer {
    std::uint32_t found;    ///< the column has the own layer, and so a result (possibly no hit)
    std::uint32_t doubtful; ///< the result is right only if the surface can be hit from the origin
};

template <bool kPacked>
Answer store_answers(WalkLanes<kPacked> const& w, QueryBatch& b, std::size_t first, Columns const& columns,
                     std::size_t column)
{
    Floats const d;
    Words const words;
    GridLanes const& g = w.g;
    auto const set = [&](float v) { return hn::Set(d, v); };
    Mask const answered = hn::And(w.found, w.hit);
    I const layer_at = hn::IfThenElseZero(hn::RebindMask(Integers(), answered), w.answer_at);
    LayerLanes const layer = load_layers<kPacked>(w.pool, g, layer_at);
    Mask const along = hn::RebindMask(d, hn::TestBit(layer.primitive, hn::Set(words, kAlongAxis)));
    Mask const back = hn::Not(hn::Xor(along, hn::Gt(w.sign, hn::Zero(d))));
    V const gap = hn::Sub(hn::MulSub(w.sign, layer.depth, w.origin), w.own_depth);
    Mask const doubtful = hn::And(answered, hn::Or(back, hn::Lt(gap, hn::Mul(set(4), g.texel))));
    V const u = hn::MulAdd(hn::Add(hn::Load(d, columns.i + column), set(0.5f)), g.texel, g.corner_x);
    V const v = hn::MulAdd(hn::Add(hn::Load(d, columns.j + column), set(0.5f)), g.texel, g.corner_y);
    auto const store = [&](std::size_t k, std::vector<float>& to) {
        hn::StoreU(hn::MulAdd(layer.depth, g.axis[k], hn::MulAdd(v, g.up[k], hn::Mul(u, g.right[k]))), d,
                   to.data() + first);
    };
    store(0, b.hit_x);
    store(1, b.hit_y);
    store(2, b.hit_z);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(words, answered), layer.primitive, hn::Set(words, kNoLayerHit)),
               words, b.hit.data() + first);
    hn::StoreU(
        hn::IfThenElse(hn::RebindMask(words, w.found), hn::BitCast(words, layer_at), hn::Set(words, kNoLayerHit)),
        words, b.hit_layer.data() + first);
    return {bits_of(w.found), bits_of(doubtful)};
}

/// @param grids, column  of the first vector of the pair
template <bool kPacked>
Answer answer_pair(AxisPool const& pool, GridLanes const* grids, QueryBatch& b, std::size_t first,
                   Columns const& columns, std::size_t column)
{
    Integers const integers;
    std::size_t const lanes = hn::Lanes(integers);
    auto const begin = [&](std::size_t at) { return hn::Load(integers, columns.begin + at); };
    auto const end = [&](std::size_t at) { return hn::Load(integers, columns.end + at); };
    WalkLanes<kPacked> w(pool, grids[0], b, first, begin(column), end(column));
    WalkLanes<kPacked> x(pool, grids[1], b, first + lanes, begin(column + lanes), end(column + lanes));
    while (!hn::AllFalse(Floats(), hn::Or(w.running, x.running))) {
        w.next_layer();
        x.next_layer();
    }
    Answer const one = store_answers(w, b, first, columns, column);
    Answer const two = store_answers(x, b, first + lanes, columns, column + lanes);
    return {one.found | two.found << lanes, one.doubtful | two.doubtful << lanes};
}

/// Rounded up to whole pairs of vectors, as the arrays are allocated.
std::size_t padded(std::size_t n) { return (n + 2 * kMostLanes - 1) / (2 * kMostLanes) * (2 * kMostLanes); }

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
    static constexpr bool kMany = true, kCold = true;
    AxisPool const& pool;
    std::uint32_t const* axes;

    ManyGrids(AxisPool const& p, std::size_t, QueryBatch const& b) : pool(p), axes(b.axis.data()) {}
    GridLanes operator()(std::size_t i) const { return own_grids(pool, axes + i); }
    RasterGrid const& of(std::size_t i) const { return pool.grids[axes[i]]; }
};

/// @param kBufferIsCold  few look-ups spread over many texels
template <bool kBufferIsCold>
struct OneGrid {
    static constexpr bool kMany = false, kCold = kBufferIsCold;
    GridLanes pair[2];
    RasterGrid const& plain;

    OneGrid(AxisPool const& p, std::size_t a, QueryBatch const&)
        : pair{same_grid(p, a), same_grid(p, a)}, plain(p.grids[a])
    {
    }
    RasterGrid const& of(std::size_t) const { return plain; }
};

/// Prefetches the batch: it is read and written as ten or eleven streams, more than the hardware prefetches.
template <bool kWithAxes>
void fetch_streams(QueryBatch& b, std::size_t i)
{
    for (auto* const a : {&b.x, &b.y, &b.z, &b.slope}) __builtin_prefetch(a->data() + i);
    __builtin_prefetch(b.triangle.data() + i);
    if constexpr (kWithAxes) __builtin_prefetch(b.axis.data() + i);
    for (auto* const a : {&b.hit_x, &b.hit_y, &b.hit_z}) __builtin_prefetch(a->data() + i, 1);
    for (auto* const a : {&b.hit, &b.hit_layer}) __builtin_prefetch(a->data() + i, 1);
}

/// Runs one attempt for all look-ups of the batch; indices of those without an accepted result go to `unsure`.
/// @tparam kAccepts  false: all results of columns with an own layer are accepted
template <class Grids, bool kAccepts = true>
void ask(AxisPool const& pool, Grids const& grids, View<Surface const> surfaces, int attempt, QueryBatch& b,
         std::vector<std::uint32_t>& unsure)
{
    std::size_t const lanes = hn::Lanes(Floats()), two = 2 * lanes, n = b.size(), pairs = (n + two - 1) / two;
    auto const answer = pool.packed.empty() ? answer_pair<false> : answer_pair<true>;
    thread_local Columns columns;
    thread_local GridLanes grids_ahead[2 * Columns::kPairs];
    thread_local std::vector<std::uint32_t> doubtful, doubted;
    doubtful.clear();
    doubted.clear();
    unsure.clear();
    auto const slot = [](std::size_t pair) { return pair % Columns::kPairs * 2; };
    auto const grids_of = [&](std::size_t pair) -> GridLanes const* {
        if constexpr (Grids::kMany)
            return grids_ahead + slot(pair);
        else
            return grids.pair;
    };
    auto const queries_of = [&](std::size_t pair) { return std::min(two, n - pair * two); };
    auto const check = [&](std::vector<std::uint32_t>& queries) {
        for (std::uint32_t const q : queries) // their surfaces have been prefetched by now
            if (!query_detail::can_be_hit(surfaces[b.hit[q] & kPrimitiveMask], b.hit[q], b.origin(q), grids.of(q)))
                unsure.push_back(q);
        queries.clear();
    };
    constexpr std::size_t kAhead = Grids::kCold ? Columns::kAhead : 0, kStreamsAhead = 8;
    for (std::size_t step = 0; step < pairs + kAhead; ++step) {
        if (step < pairs) {
            for (std::size_t k = 0; k < 2; ++k) {
                std::size_t const i = step * two + k * lanes, ahead = i + kStreamsAhead * two;
                if (ahead < n) fetch_streams<Grids::kMany>(b, ahead);
                if constexpr (Grids::kMany) grids_ahead[slot(step) + k] = grids(i);
                find_columns(grids_of(step)[k], attempt, b, i, (slot(step) + k) * lanes, columns);
            }
            if constexpr (Grids::kCold) fetch_offsets(pool, columns, slot(step) * lanes, queries_of(step));
        }
        if constexpr (Grids::kCold) {
            std::size_t const pair = step - (kAhead - Columns::kLayersAhead); // may wrap
            if (pair < pairs) {
                find_ranges(pool, columns, slot(pair) * lanes, two);
                if (pool.packed.empty())
                    fetch_layers(pool.layers, columns, slot(pair) * lanes, queries_of(pair));
                else
                    fetch_layers(pool.packed, columns, slot(pair) * lanes, queries_of(pair));
            }
            if (step < kAhead) continue;
        }
        std::size_t const pair = step - kAhead, first = pair * two;
        if constexpr (Grids::kCold) {
            if (pool.packed.empty())
                touch_layers(pool.layers, columns, slot(pair) * lanes, queries_of(pair));
            else
                touch_layers(pool.packed, columns, slot(pair) * lanes, queries_of(pair));
        } else {
            find_ranges(pool, columns, slot(pair) * lanes, two);
        }
        Answer const a = answer(pool, grids_of(pair), b, first, columns, slot(pair) * lanes);
        if (b.watched)
            for (std::size_t k = 0; k < queries_of(pair); ++k)
                b.near_moving[first + k] = columns.moved[slot(pair) * lanes + k];
        // A pair has up to 32 lanes.
        std::uint32_t const there = queries_of(pair) < 32 ? (1u << queries_of(pair)) - 1 : ~0u;
        for (std::uint32_t bits = kAccepts ? a.doubtful & there : 0; bits != 0; bits &= bits - 1) {
            std::uint32_t const q = std::uint32_t(first) + std::uint32_t(std::countr_zero(bits));
            __builtin_prefetch(&surfaces[b.hit[q] & kPrimitiveMask]);
            doubtful.push_back(q);
        }
        for (std::uint32_t bits = ~a.found & there; bits != 0; bits &= bits - 1)
            unsure.push_back(std::uint32_t(first) + std::uint32_t(std::countr_zero(bits)));
        if (pair % 4 != 3) continue;
        check(doubted);
        std::swap(doubtful, doubted);
    }
    check(doubted);
    check(doubtful);
    std::ranges::sort(unsure);
}

/// SIMD form of is_doubtful, for look-ups that are answered and whose nearest column was accepted.
template <class Grids>
void compare_columns(AxisPool const& pool, std::size_t a, View<Surface const> surfaces, QueryBatch& b)
{
    using namespace query_detail;
    enum : std::uint8_t { kDiffers = 1, kByLot = 2 };
    thread_local std::vector<std::uint32_t> compared, unsure;
    thread_local std::vector<std::uint8_t> seen;
    thread_local QueryBatch other;
    compared.clear();
    seen.clear();
    for (std::uint32_t i = 0; i < b.size(); ++i) {
        if (b.doubtful[i] != 0) continue;
        compared.push_back(i);
        seen.push_back(is_by_lot(surfaces, b.found(i).triangle) ? kByLot : 0);
    }
    other.watched = b.watched;
    other.resize(compared.size());
    for (std::size_t k = 0; k < compared.size(); ++k) copy_query(b, compared[k], other, k);
    Grids const grids(pool, a, other);
    for (int attempt = 1; attempt < 4; ++attempt) {
        ask<Grids, false>(pool, grids, surfaces, attempt, other, unsure);
        for (std::uint32_t const k : unsure) b.doubtful[compared[k]] = 1;
        for (std::size_t k = 0; k < compared.size(); ++k) {
            std::uint32_t const i = compared[k];
            if (b.watched) b.near_moving[i] |= other.near_moving[k];
            if (other.hit[k] == b.hit[i]) continue;
            if (are_different(surfaces, grids.of(k), b.found(i), other.found(k))) seen[k] |= kDiffers;
            if (is_by_lot(surfaces, other.found(k).triangle)) seen[k] |= kByLot;
        }
    }
    for (std::size_t k = 0; k < compared.size(); ++k)
        if (seen[k] == kDiffers) b.doubtful[compared[k]] = 1;
}

/// Result of the nearest column without an own layer: the first face towards the walk.
void answer_plainly(AxisPool const& pool, std::size_t a, QueryBatch& b, std::size_t i)
{
    WalkOrigin const o = b.origin(i);
    RasterGrid const& grid = pool.grids[a];
    auto const nearest = [&](vec3 across, float corner, std::uint32_t count) {
        float const at = std::floor((glm::dot(o.position, across) - corner) / grid.texel);
        return std::uint32_t(std::min(std::max(at, 0.0f), float(count - 1)));
    };
    std::uint32_t const ti = nearest(grid.right, grid.corner.x, grid.width),
                        tj = nearest(grid.up, grid.corner.y, grid.height);
    float const sign = o.up ? 1.0f : -1.0f, origin = sign * grid.depth(o.position);
    std::size_t const texel = pool.first_offset[a] + std::size_t(tj) * grid.width + ti;
    auto const [begin, end] = pool.column(texel);
    for (std::uint32_t k = begin; k < end; ++k) {
        std::uint32_t const at = pool.first_layer[a] + (o.up ? k : end - 1 - (k - begin));
        HitLayer const layer = pool.layer(a, at);
        if (query_detail::is_back(layer.primitive, o) || sign * layer.depth - origin <= grid.rounding) continue;
        vec3 const p = grid.point(ti, tj, layer.depth);
        b.hit[i] = layer.primitive;
        b.hit_layer[i] = at;
        b.hit_x[i] = p.x;
        b.hit_y[i] = p.y;
        b.hit_z[i] = p.z;
        return;
    }
}

template <class Grids>
void answer_all(AxisPool const& pool, std::size_t a, View<Surface const> surfaces, QueryBatch& b)
{
    thread_local std::vector<std::uint32_t> waiting, unsure;
    thread_local QueryBatch again;
    b.resize(b.size());
    ask(pool, Grids(pool, a, b), surfaces, 0, b, waiting);
    if (b.checked) {
        std::ranges::fill(b.doubtful, 0);
        for (std::uint32_t const i : waiting) b.doubtful[i] = 1;
    }
    for (int attempt = 1; attempt < 4 && !waiting.empty(); ++attempt) {
        again.watched = b.watched;
        again.resize(waiting.size());
        for (std::size_t k = 0; k < waiting.size(); ++k) copy_query(b, waiting[k], again, k);
        ask(pool, Grids(pool, a, again), surfaces, attempt, again, unsure);
        std::size_t left = 0, next = 0;
        for (std::uint32_t k = 0; k < waiting.size(); ++k) {
            std::uint32_t const i = waiting[k];
            if (b.watched) b.near_moving[i] |= again.near_moving[k];
            if (next < unsure.size() && unsure[next] == k) {
                ++next;
                waiting[left++] = i;
                // The first result of a column with an own layer is used if none is accepted.
                if (b.hit_layer[i] != kNoLayerHit || again.hit_layer[k] == kNoLayerHit) continue;
            }
            b.hit[i] = again.hit[k];
            b.hit_layer[i] = again.hit_layer[k];
            b.hit_x[i] = again.hit_x[k];
            b.hit_y[i] = again.hit_y[k];
            b.hit_z[i] = again.hit_z[k];
        }
        waiting.resize(left);
    }
    for (std::uint32_t const i : waiting)
        if (b.hit_layer[i] == kNoLayerHit) answer_plainly(pool, Grids::kMany ? b.axis[i] : a, b, i);
    if (b.checked) compare_columns<Grids>(pool, a, surfaces, b);
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
    near_moving.resize(watched ? n : 0);
    doubtful.resize(checked ? n : 0);
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
    constexpr std::size_t kWarm = 4; // look-ups per texel
    if (batch.size() < kWarm * pool.grids[a].texels())
        answer_all<OneGrid<true>>(pool, a, surfaces, batch);
    else
        answer_all<OneGrid<false>>(pool, a, surfaces, batch);
}

} // namespace gi
