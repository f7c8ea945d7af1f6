#include "gi/raster/deep_raster.h"

#include "gi/raster/clip.h"
#include "gi/raster/lanes.h"
#include "gi/raster/nearest_map.h"

#include <algorithm>

namespace gi {
namespace {

using namespace lanes;

/// Snapped corners and depths of triangles queued until they fill a vector.
struct Queue {
    enum Column { x0, x1, x2, y0, y1, y2, z0, z1, z2, kColumns };

    alignas(64) float values[kColumns][3 * kMostLanes];
    alignas(64) std::uint32_t triangle[3 * kMostLanes];
    std::size_t count = 0;
};

/// Projected corners of one vector of triangles.
struct Projected {
    V x[3], y[3]; ///< subpixels
    V z[3];       ///< depth
    Mask clip;    ///< lanes that need clipping; their other values are undefined
};

struct Corners {
    V x[3], y[3], z[3]; ///< m
};

struct OrthographicLanes {
    static constexpr bool kLargeMayLieBeside = true; ///< triangles that reach beyond the grid are not clipped
    RasterGrid const& grid;
    V to_x[3], to_y[3], to_z[3], x_zero, y_zero;

    explicit OrthographicLanes(RasterGrid const& g) : grid(g)
    {
        Floats const d;
        for (glm::length_t c = 0; c < 3; ++c) {
            to_x[c] = hn::Set(d, g.to_x[c]);
            to_y[c] = hn::Set(d, g.to_y[c]);
            to_z[c] = hn::Set(d, g.axis[c]);
        }
        x_zero = hn::Set(d, g.x0);
        y_zero = hn::Set(d, g.y0);
    }
    void project(Corners const& p, Projected& out) const
    {
        auto const row = [&](V const* to, V zero, std::size_t k) {
            return hn::Round(
                hn::MulAdd(p.z[k], to[2], hn::MulAdd(p.y[k], to[1], hn::MulAdd(p.x[k], to[0], zero))));
        };
        for (std::size_t k = 0; k < 3; ++k) {
            out.x[k] = row(to_x, x_zero, k);
            out.y[k] = row(to_y, y_zero, k);
        }
        out.clip = hn::FirstN(Floats(), 0);
    }
    /// Separate from projection, because most triangles are dropped before their depth is needed.
    void add_depth(Corners const& p, Projected& out) const
    {
        for (std::size_t k = 0; k < 3; ++k)
            out.z[k] = hn::MulAdd(p.z[k], to_z[2], hn::MulAdd(p.y[k], to_z[1], hn::Mul(p.x[k], to_z[0])));
    }
    template <class Emit>
    void clip(vec3 const*, Emit const&) const
    {
    }
};

struct PerspectiveLanes {
    static constexpr bool kLargeMayLieBeside = false;
    PerspectiveGrid const& grid;
    V to_x[3], to_y[3], to_w[3], eye[3];

    explicit PerspectiveLanes(PerspectiveGrid const& g) : grid(g)
    {
        Floats const d;
        for (glm::length_t c = 0; c < 3; ++c) {
            to_x[c] = hn::Set(d, g.to_x[c]);
            to_y[c] = hn::Set(d, g.to_y[c]);
            to_w[c] = hn::Set(d, g.forward[c]);
            eye[c] = hn::Set(d, g.eye[c]);
        }
    }
    void project(Corners const& p, Projected& out) const
    {
        Floats const d;
        V const near = hn::Set(d, grid.near_m), guard = hn::Set(d, PerspectiveGrid::kGuard), one = hn::Set(d, 1);
        V nearest = hn::Set(d, kInf), farthest = hn::Set(d, -kInf), widest = hn::Zero(d);
        for (std::size_t k = 0; k < 3; ++k) {
            V const v[3] = {hn::Sub(p.x[k], eye[0]), hn::Sub(p.y[k], eye[1]), hn::Sub(p.z[k], eye[2])};
            auto const row = [&](V const* to) {
                return hn::MulAdd(v[2], to[2], hn::MulAdd(v[1], to[1], hn::Mul(v[0], to[0])));
            };
            V const w = row(to_w);
            nearest = hn::Min(nearest, w);
            farthest = hn::Max(farthest, w);
            out.z[k] = hn::Div(one, w);
            out.x[k] = hn::Round(hn::Mul(row(to_x), out.z[k]));
            out.y[k] = hn::Round(hn::Mul(row(to_y), out.z[k]));
            widest = hn::Max(widest, hn::Max(hn::Abs(out.x[k]), hn::Abs(out.y[k])));
        }
        Mask const behind = hn::Le(farthest, near);
        Mask const plain = hn::And(hn::Gt(nearest, near), hn::Le(widest, guard));
        out.clip = hn::Not(hn::Or(behind, plain));
        // Lanes that are behind the eye or need clipping get no samples here.
        V const nowhere = hn::Set(d, -grid.subpixels);
        Mask const gone = hn::Not(plain);
        for (std::size_t k = 0; k < 3; ++k) {
            out.x[k] = hn::IfThenElse(gone, nowhere, out.x[k]);
            out.y[k] = hn::IfThenElse(gone, nowhere, out.y[k]);
        }
    }
    void add_depth(Corners const&, Projected&) const {}
    template <class Emit>
    void clip(vec3 const* corner, Emit const& emit) const
    {
        clip_triangle(grid, corner, emit);
    }
};

/// Rasterises one range of triangles over one grid.
template <class Lanes>
class VectorRaster {
public:
    template <class Grid>
    VectorRaster(Grid const& grid, MacroPath macro, Fragments& out)
        : lanes_(grid),
          macro_(macro),
          out_(out),
          subpixels_(grid.subpixels),
          width_(grid.width),
          height_(grid.height)
    {
    }

    /// Some triangles may stay queued until finish().
    void run(TriangleSoup const& soup, std::size_t first, std::size_t last);
    void finish();

private:
    struct Samples {
        V first_i, last_i, first_j, last_j;
    };

    Samples sample_bounds(V x0, V x1, V x2, V y0, V y1, V y2) const;
    void empty_queue(Queue& queue, std::size_t lanes);
    void scan_large(SnappedTriangle const& t, vec3 depth, std::uint32_t triangle);
    void test_exactly(Queue const& queue, std::size_t at, std::uint32_t i, std::uint32_t j);

    Lanes lanes_;
    MacroPath macro_;
    Fragments& out_;
    float subpixels_;
    std::uint32_t width_, height_;
    Queue single_, few_;
};

template <class Lanes>
typename VectorRaster<Lanes>::Samples VectorRaster<Lanes>::sample_bounds(V x0, V x1, V x2, V y0, V y1, V y2) const
{
    Floats const d;
    V const per_texel = hn::Set(d, 1 / subpixels_), half = hn::Set(d, 0.5f), zero = hn::Zero(d);
    auto const first = [&](V a, V b, V c) {
        return hn::Max(hn::Ceil(hn::MulSub(hn::Min(a, hn::Min(b, c)), per_texel, half)), zero);
    };
    auto const last = [&](V a, V b, V c, std::uint32_t count) {
        return hn::Min(hn::Floor(hn::MulSub(hn::Max(a, hn::Max(b, c)), per_texel, half)),
                       hn::Set(d, float(count) - 1));
    };
    return {first(x0, x1, x2), last(x0, x1, x2, width_), first(y0, y1, y2), last(y0, y1, y2, height_)};
}

template <class Lanes>
void VectorRaster<Lanes>::scan_large(SnappedTriangle const& t, vec3 depth, std::uint32_t triangle)
{
    TriangleScan const s = start_scan(t, std::int32_t(subpixels_), width_, height_);
    if (s.empty) return;
    DepthPlane const plane = depth_plane(t, std::int32_t(subpixels_), depth);
    std::uint32_t const id = triangle | (s.along ? kAlongAxis : 0);
    scan(s, macro_, [&](std::uint32_t j, std::uint32_t first, std::uint32_t last) {
        std::size_t const n = last - first + 1;
        out_.reserve(n);
        std::uint32_t* const texel = out_.texel.get() + out_.count;
        float* const z = out_.depth.get() + out_.count;
        std::uint32_t* const primitive = out_.primitive.get() + out_.count;
        for (std::uint32_t k = 0; k < n; ++k) {
            texel[k] = j * width_ + first + k;
            z[k] = plane.at(first + k, j);
            primitive[k] = id;
        }
        out_.count += n;
    });
}

/// Exact test for the rare lanes whose sample lies too close to an edge for floats to determine the side.
template <class Lanes>
void VectorRaster<Lanes>::test_exactly(Queue const& queue, std::size_t at, std::uint32_t i, std::uint32_t j)
{
    auto const integer = [&](Queue::Column c) { return std::int32_t(queue.values[c][at]); };
    SnappedTriangle const t{{integer(Queue::x0), integer(Queue::x1), integer(Queue::x2)},
                            {integer(Queue::y0), integer(Queue::y1), integer(Queue::y2)}};
    TriangleScan const s = start_scan(t, std::int32_t(subpixels_), width_, height_);
    if (s.empty) return;
    for (HalfPlane const& e : s.edge)
        if (e.value(i, j) < 0) return;
    vec3 const depth{queue.values[Queue::z0][at], queue.values[Queue::z1][at], queue.values[Queue::z2][at]};
    out_.append(j * width_ + i, depth_plane(t, std::int32_t(subpixels_), depth).at(i, j),
                queue.triangle[at] | (s.along ? kAlongAxis : 0));
}

/// Tests the last `lanes` triangles of the queue against the samples within their bounds, and removes them.
template <class Lanes>
void VectorRaster<Lanes>::empty_queue(Queue& queue, std::size_t lanes)
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
    Samples const b = sample_bounds(x0, x1, x2, y0, y1, y2);
    V const one = hn::Set(d, 1), half = hn::Set(d, 0.5f), subpixels = hn::Set(d, subpixels_);
    V const width = hn::Set(d, float(width_)), zero = hn::Zero(d);
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
            // Rounding is monotonic: if two rounded products differ, the exact ones differ in the same direction.
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
                std::uint32_t const bits = bits_of(unclear);
                for (std::size_t k = 0; k < lanes; ++k)
                    if ((bits >> k & 1) != 0)
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

template <class Lanes>
void VectorRaster<Lanes>::run(TriangleSoup const& soup, std::size_t first, std::size_t last)
{
    Floats const d;
    Words const words;
    std::size_t const lanes = hn::Lanes(d);
    V const most_micro = hn::Set(d, float(kMicroSide - 1)), zero = hn::Zero(d);

    for (std::size_t t = first; t < last; t += lanes) {
        Corners p;
        for (std::size_t k = 0; k < 3; ++k) {
            p.x[k] = hn::LoadU(d, soup.corner[3 * k].data() + t);
            p.y[k] = hn::LoadU(d, soup.corner[3 * k + 1].data() + t);
            p.z[k] = hn::LoadU(d, soup.corner[3 * k + 2].data() + t);
        }
        Mask const there = hn::FirstN(d, std::min(lanes, last - t));
        Projected q;
        lanes_.project(p, q);
        V const *const x = q.x, *const y = q.y, *const z = q.z;
        Samples const b = sample_bounds(x[0], x[1], x[2], y[0], y[1], y[2]);
        V const across = hn::Sub(b.last_i, b.first_i), down = hn::Sub(b.last_j, b.first_j);
        Mask const clipped = hn::And(there, q.clip);
        if (!hn::AllFalse(d, clipped)) {
            std::uint32_t const bits = bits_of(clipped);
            for (std::size_t k = 0; k < lanes; ++k) {
                if ((bits >> k & 1) == 0) continue;
                vec3 const corner[3] = {soup.vertex(t + k, 0), soup.vertex(t + k, 1), soup.vertex(t + k, 2)};
                lanes_.clip(corner, [&](SnappedTriangle const& part, vec3 depth) {
                    scan_large(part, depth, std::uint32_t(t + k));
                });
            }
        }
        Mask const any = hn::And(hn::Ge(hn::Min(across, down), zero), there);
        if (hn::AllFalse(d, any)) continue;
        lanes_.add_depth(p, q);
        auto const triangle = hn::Iota(words, std::uint32_t(t));
        V const side = hn::Max(across, down);
        Mask micro = hn::Le(side, most_micro), one = hn::Le(side, zero);
        if constexpr (Lanes::kLargeMayLieBeside) { // products of their coordinates would round depths too much
            auto const extent = [](V const* v) {
                return hn::Sub(hn::Max(v[0], hn::Max(v[1], v[2])), hn::Min(v[0], hn::Min(v[1], v[2])));
            };
            V const most = hn::Set(d, float(kMicroSide + 1) * subpixels_);
            Mask const small = hn::Le(hn::Max(extent(x), extent(y)), most);
            micro = hn::And(micro, small);
            one = hn::And(one, small);
        }
        auto const push = [&](Queue& queue, Mask mask) {
            if (hn::AllFalse(d, mask)) return;
            V const all[] = {x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]};
            for (std::size_t c = 0; c < Queue::kColumns; ++c)
                hn::CompressStore(all[c], mask, d, queue.values[c] + queue.count);
            queue.count +=
                hn::CompressStore(triangle, hn::RebindMask(words, mask), words, queue.triangle + queue.count);
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
        std::uint32_t const bits = bits_of(large);
        for (std::size_t k = 0; k < lanes; ++k) {
            if ((bits >> k & 1) == 0) continue;
            auto const integer = [&](std::size_t c) { return std::int32_t(corners[c][k]); };
            scan_large({{integer(0), integer(1), integer(2)}, {integer(3), integer(4), integer(5)}},
                       {corners[6][k], corners[7][k], corners[8][k]}, std::uint32_t(t + k));
        }
    }
}

template <class Lanes>
void VectorRaster<Lanes>::finish()
{
    std::size_t const lanes = hn::Lanes(Floats());
    while (single_.count > 0) empty_queue(single_, std::min(lanes, single_.count));
    while (few_.count > 0) empty_queue(few_, std::min(lanes, few_.count));
}

} // namespace

void rasterize(TriangleSoup const& soup, std::size_t first, std::size_t last, RasterGrid const& grid,
               MacroPath macro, Fragments& out)
{
    VectorRaster<OrthographicLanes> raster(grid, macro, out);
    raster.run(soup, first, last);
    raster.finish();
}

void rasterize(TriangleSoup const& soup, std::size_t first, std::size_t last, PerspectiveGrid const& grid,
               Fragments& out)
{
    VectorRaster<PerspectiveLanes> raster(grid, MacroPath::edge_table, out);
    for (std::size_t at = first; at < last;) {
        std::size_t const chunk = at / TriangleSoup::kChunk;
        std::size_t const end = std::min(last, (chunk + 1) * TriangleSoup::kChunk);
        if (sees(grid, soup.chunks[chunk])) raster.run(soup, at, end);
        at = end;
    }
    raster.finish();
}

} // namespace gi
