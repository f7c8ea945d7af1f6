#include "gi/raster/deep_raster.h"

#include <algorithm>
#include <hwy/highway.h>

namespace gi {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Words = hn::RebindToUnsigned<Floats>;
using Integers = hn::RebindToSigned<Floats>;
using V = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;
constexpr std::size_t kMostLanes = HWY_MAX_BYTES / sizeof(float);

/// Snapped corners and depths of triangles that wait for a full vector.
struct Queue {
    enum Column { x0, x1, x2, y0, y1, y2, z0, z1, z2, kColumns };

    alignas(64) float values[kColumns][3 * kMostLanes];
    alignas(64) std::uint32_t triangle[3 * kMostLanes];
    std::size_t count = 0;
};

/// One range of triangles over one grid.
class VectorRaster {
public:
    VectorRaster(RasterGrid const& grid, MacroPath macro, Fragments& out) : grid_(grid), macro_(macro), out_(out) {}

    void run(TriangleSoup const& soup, std::size_t first, std::size_t last);

private:
    struct Bounds {
        V first_i, last_i, first_j, last_j;
    };

    Bounds sample_bounds(V x0, V x1, V x2, V y0, V y1, V y2) const;
    void empty_queue(Queue& queue, std::size_t lanes);
    void scan_large(SnappedTriangle const& t, vec3 depth, std::uint32_t triangle);
    void test_exactly(Queue const& queue, std::size_t at, std::uint32_t i, std::uint32_t j);

    RasterGrid const& grid_;
    MacroPath macro_;
    Fragments& out_;
    Queue single_, few_;
};

VectorRaster::Bounds VectorRaster::sample_bounds(V x0, V x1, V x2, V y0, V y1, V y2) const
{
    Floats const d;
    V const per_texel = hn::Set(d, 1 / grid_.subpixels), half = hn::Set(d, 0.5f), zero = hn::Zero(d);
    auto const first = [&](V a, V b, V c) {
        return hn::Max(hn::Ceil(hn::MulSub(hn::Min(a, hn::Min(b, c)), per_texel, half)), zero);
    };
    auto const last = [&](V a, V b, V c, std::uint32_t count) {
        return hn::Min(hn::Floor(hn::MulSub(hn::Max(a, hn::Max(b, c)), per_texel, half)),
                       hn::Set(d, float(count) - 1));
    };
    return {first(x0, x1, x2), last(x0, x1, x2, grid_.width), first(y0, y1, y2), last(y0, y1, y2, grid_.height)};
}

void VectorRaster::scan_large(SnappedTriangle const& t, vec3 depth, std::uint32_t triangle)
{
    TriangleScan const s = start_scan(t, std::int32_t(grid_.subpixels), grid_.width, grid_.height);
    if (s.empty) return;
    DepthPlane const plane = depth_plane(t, std::int32_t(grid_.subpixels), depth);
    std::uint32_t const id = triangle | (s.along ? kAlongAxis : 0);
    scan(s, macro_, [&](std::uint32_t j, std::uint32_t first, std::uint32_t last) {
        std::size_t const n = last - first + 1;
        out_.reserve(n);
        std::uint32_t* const texel = out_.texel.get() + out_.count;
        float* const z = out_.depth.get() + out_.count;
        std::uint32_t* const primitive = out_.primitive.get() + out_.count;
        for (std::uint32_t k = 0; k < n; ++k) {
            texel[k] = j * grid_.width + first + k;
            z[k] = plane.at(first + k, j);
            primitive[k] = id;
        }
        out_.count += n;
    });
}

/// For the rare lanes whose sample lies so near to an edge that floats cannot tell the side.
void VectorRaster::test_exactly(Queue const& queue, std::size_t at, std::uint32_t i, std::uint32_t j)
{
    auto const integer = [&](Queue::Column c) { return std::int32_t(queue.values[c][at]); };
    SnappedTriangle const t{{integer(Queue::x0), integer(Queue::x1), integer(Queue::x2)},
                            {integer(Queue::y0), integer(Queue::y1), integer(Queue::y2)}};
    TriangleScan const s = start_scan(t, std::int32_t(grid_.subpixels), grid_.width, grid_.height);
    if (s.empty) return;
    for (HalfPlane const& e : s.edge)
        if (e.value(i, j) < 0) return;
    vec3 const depth{queue.values[Queue::z0][at], queue.values[Queue::z1][at], queue.values[Queue::z2][at]};
    out_.append(j * grid_.width + i, depth_plane(t, std::int32_t(grid_.subpixels), depth).at(i, j),
                queue.triangle[at] | (s.along ? kAlongAxis : 0));
}

/// Tests the last `lanes` triangles of the queue against the samples within their bounds, and removes them.
void VectorRaster::empty_queue(Queue& queue, std::size_t lanes)
{
    Floats const d;
    Words const words;
    std::size_t const first = queue.count - lanes;
    queue.count = first;
    auto const column = [&](Queue::Column c) { return hn::LoadU(d, queue.values[c] + first); };
    V const x0 = column(Queue::x0), x1 = column(Queue::x1), x2 = column(Queue::x2);
    V const y0 = column(Queue::y0), y1 = column(Queue::y1), y2 = column(Queue::y2);
    V const z0 = column(Queue::z0), z1 = column(Queue::z1), z2 = column(Queue::z2);
    auto const triangle = hn::LoadU(words, queue.triangle + first);
    Mask const used = hn::FirstN(d, lanes);
    Bounds const b = sample_bounds(x0, x1, x2, y0, y1, y2);
    V const one = hn::Set(d, 1), half = hn::Set(d, 0.5f), subpixels = hn::Set(d, grid_.subpixels);
    V const width = hn::Set(d, float(grid_.width)), zero = hn::Zero(d);
    for (V j = b.first_j;; j = hn::Add(j, one)) {
        Mask const row = hn::And(used, hn::Le(j, b.last_j));
        if (hn::AllFalse(d, row)) break;
        V const cy = hn::Mul(hn::Add(j, half), subpixels);
        V const ay = hn::Sub(y0, cy), by = hn::Sub(y1, cy), ey = hn::Sub(y2, cy);
        for (V i = b.first_i;; i = hn::Add(i, one)) {
            Mask const active = hn::And(row, hn::Le(i, b.last_i));
            if (hn::AllFalse(d, active)) break;
            V const cx = hn::Mul(hn::Add(i, half), subpixels);
            V const ax = hn::Sub(x0, cx), bx = hn::Sub(x1, cx), ex = hn::Sub(x2, cx);
            // Rounding is monotonic: where two rounded products differ, the exact ones differ to the same side.
            V const p01 = hn::Mul(ax, by), q01 = hn::Mul(ay, bx);
            V const p12 = hn::Mul(bx, ey), q12 = hn::Mul(by, ex);
            V const p20 = hn::Mul(ex, ay), q20 = hn::Mul(ey, ax);
            Mask const more01 = hn::Gt(p01, q01), more12 = hn::Gt(p12, q12), more20 = hn::Gt(p20, q20);
            Mask const less01 = hn::Lt(p01, q01), less12 = hn::Lt(p12, q12), less20 = hn::Lt(p20, q20);
            Mask const along = hn::And(more01, hn::And(more12, more20));
            Mask const against = hn::And(less01, hn::And(less12, less20));
            Mask const some_more = hn::Or(more01, hn::Or(more12, more20));
            Mask const some_less = hn::Or(less01, hn::Or(less12, less20));
            Mask const clear = hn::Or(hn::Or(along, against), hn::And(some_more, some_less));
            Mask const unclear = hn::AndNot(clear, active);
            Mask const covered = hn::And(active, hn::Or(along, against));
            if (!hn::AllFalse(d, unclear)) {
                HWY_ALIGN float at_i[kMostLanes];
                HWY_ALIGN float at_j[kMostLanes];
                hn::Store(i, d, at_i);
                hn::Store(j, d, at_j);
                std::uint8_t bits[8] = {};
                hn::StoreMaskBits(d, unclear, bits);
                for (std::size_t k = 0; k < lanes; ++k)
                    if ((bits[k / 8] >> (k % 8) & 1) != 0)
                        test_exactly(queue, first + k, std::uint32_t(at_i[k]), std::uint32_t(at_j[k]));
            }
            if (hn::AllFalse(d, covered)) continue;
            V const w0 = hn::Sub(p12, q12), w1 = hn::Sub(p20, q20), w2 = hn::Sub(p01, q01);
            V const sum = hn::Add(w0, hn::Add(w1, w2));
            V const weighted = hn::MulAdd(w0, z0, hn::MulAdd(w1, z1, hn::Mul(w2, z2)));
            V const z = hn::IfThenElse(hn::Eq(sum, zero), z0, hn::Div(weighted, sum));
            auto const texel = hn::BitCast(words, hn::ConvertTo(Integers(), hn::MulAdd(j, width, i)));
            auto const facing = hn::IfThenElseZero(hn::RebindMask(words, along), hn::Set(words, kAlongAxis));
            out_.reserve(kMostLanes);
            hn::CompressStore(z, covered, d, out_.depth.get() + out_.count);
            hn::CompressStore(texel, hn::RebindMask(words, covered), words, out_.texel.get() + out_.count);
            out_.count += hn::CompressStore(hn::Or(triangle, facing), hn::RebindMask(words, covered), words,
                                            out_.primitive.get() + out_.count);
        }
    }
}

void VectorRaster::run(TriangleSoup const& soup, std::size_t first, std::size_t last)
{
    Floats const d;
    Words const words;
    std::size_t const lanes = hn::Lanes(d);
    auto const load = [&](std::size_t c, std::size_t t) { return hn::LoadU(d, soup.corner[c].data() + t); };
    auto const rows = [&](vec3 to) { return std::array{hn::Set(d, to.x), hn::Set(d, to.y), hn::Set(d, to.z)}; };
    auto const to_x = rows(grid_.to_x), to_y = rows(grid_.to_y), to_z = rows(grid_.axis);
    V const x_zero = hn::Set(d, grid_.x0), y_zero = hn::Set(d, grid_.y0);
    V const most_micro = hn::Set(d, float(kMicroSide - 1)), zero = hn::Zero(d);

    for (std::size_t t = first; t < last; t += lanes) {
        V x[3], y[3];
        for (std::size_t k = 0; k < 3; ++k) {
            V const px = load(3 * k, t), py = load(3 * k + 1, t), pz = load(3 * k + 2, t);
            x[k] = hn::Round(hn::MulAdd(pz, to_x[2], hn::MulAdd(py, to_x[1], hn::MulAdd(px, to_x[0], x_zero))));
            y[k] = hn::Round(hn::MulAdd(pz, to_y[2], hn::MulAdd(py, to_y[1], hn::MulAdd(px, to_y[0], y_zero))));
        }
        Bounds const b = sample_bounds(x[0], x[1], x[2], y[0], y[1], y[2]);
        V const across = hn::Sub(b.last_i, b.first_i), down = hn::Sub(b.last_j, b.first_j);
        Mask const any = hn::And(hn::Ge(hn::Min(across, down), zero), hn::FirstN(d, std::min(lanes, last - t)));
        if (hn::AllFalse(d, any)) continue;

        V z[3];
        for (std::size_t k = 0; k < 3; ++k)
            z[k] = hn::MulAdd(load(3 * k + 2, t), to_z[2],
                              hn::MulAdd(load(3 * k + 1, t), to_z[1], hn::Mul(load(3 * k, t), to_z[0])));
        auto const triangle = hn::Iota(words, std::uint32_t(t));
        V const side = hn::Max(across, down);
        Mask const micro = hn::Le(side, most_micro), one = hn::Le(side, zero);
        auto const push = [&](Queue& queue, Mask mask) {
            if (hn::AllFalse(d, mask)) return;
            V const all[] = {x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]};
            for (std::size_t c = 0; c < Queue::kColumns; ++c)
                hn::CompressStore(all[c], mask, d, queue.values[c] + queue.count);
            queue.count += hn::CompressStore(triangle, hn::RebindMask(words, mask), words, queue.triangle + queue.count);
            if (queue.count >= lanes) empty_queue(queue, lanes);
        };
        push(single_, hn::And(any, one));
        push(few_, hn::And(any, hn::AndNot(one, micro)));
        Mask const large = hn::AndNot(micro, any);
        if (hn::AllFalse(d, large)) continue;
        HWY_ALIGN float corners[9][kMostLanes];
        for (std::size_t k = 0; k < 3; ++k) {
            hn::Store(x[k], d, corners[k]);
            hn::Store(y[k], d, corners[3 + k]);
            hn::Store(z[k], d, corners[6 + k]);
        }
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(d, large, bits);
        for (std::size_t k = 0; k < lanes; ++k) {
            if ((bits[k / 8] >> (k % 8) & 1) == 0) continue;
            auto const integer = [&](std::size_t c) { return std::int32_t(corners[c][k]); };
            scan_large({{integer(0), integer(1), integer(2)}, {integer(3), integer(4), integer(5)}},
                       {corners[6][k], corners[7][k], corners[8][k]}, std::uint32_t(t + k));
        }
    }
    while (single_.count > 0) empty_queue(single_, std::min(lanes, single_.count));
    while (few_.count > 0) empty_queue(few_, std::min(lanes, few_.count));
}

} // namespace

void rasterize(TriangleSoup const& soup, std::size_t first, std::size_t last, RasterGrid const& grid,
               MacroPath macro, Fragments& out)
{
    VectorRaster(grid, macro, out).run(soup, first, last);
}

void rasterize_plain(TriangleSoup const& soup, std::size_t first, std::size_t last, RasterGrid const& grid,
                     MacroPath macro, Fragments& out)
{
    auto const subpixels = std::int32_t(grid.subpixels);
    for (std::size_t k = first; k < last; ++k) {
        vec3 const a = soup.vertex(k, 0), b = soup.vertex(k, 1), c = soup.vertex(k, 2);
        SnappedTriangle const t = snap(grid, a, b, c);
        TriangleScan const s = start_scan(t, subpixels, grid.width, grid.height);
        if (s.empty) continue;
        DepthPlane const plane = depth_plane(t, subpixels, {grid.depth(a), grid.depth(b), grid.depth(c)});
        std::uint32_t const id = std::uint32_t(k) | (s.along ? kAlongAxis : 0);
        scan(s, macro, [&](std::uint32_t j, std::uint32_t from, std::uint32_t to) {
            for (std::uint32_t i = from; i <= to; ++i) out.append(j * grid.width + i, plane.at(i, j), id);
        });
    }
}

} // namespace gi
