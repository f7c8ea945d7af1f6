#pragma once
// Traversal of traverse.h with the eight children of a node, and the four triangles of a leaf, in one vector each.
// For .cpp files only: the vectors are those of LIGHTWELL_MARCH.

#include "gi/bvh/traverse.h"
#include "gi/raster/lanes.h"

#include <bit>

namespace gi {

#if HWY_MAX_BYTES >= 32

namespace bvh_lanes {

namespace hn = hwy::HWY_NAMESPACE;
using Eight = hn::FixedTag<float, kBvhWidth>;
using EightBytes = hn::FixedTag<std::uint8_t, kBvhWidth>;
using EightIntegers = hn::FixedTag<std::int32_t, kBvhWidth>;
using Four = hn::FixedTag<float, kLeafTriangles>;
using V8 = hn::Vec<Eight>;
using V4 = hn::Vec<Four>;

template <class D>
std::uint32_t bits_of(D d, hn::Mask<D> mask)
{
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    return bytes[0];
}

inline V8 load_bytes(std::uint8_t const* from)
{
    return hn::ConvertTo(Eight(), hn::PromoteTo(EightIntegers(), hn::LoadU(EightBytes(), from)));
}

/// A ray in vectors.
struct Lanes {
    BvhRay const& ray;
    V4 origin[3], shear_x, shear_y;
    std::size_t near[3], far[3]; ///< offsets of the bytes of the near and the far planes in a node

    explicit Lanes(BvhRay const& r)
        : ray(r), shear_x(hn::Set(Four(), r.shear.shear_x)), shear_y(hn::Set(Four(), r.shear.shear_y))
    {
        for (int axis = 0; axis < 3; ++axis) {
            origin[axis] = hn::Set(Four(), r.origin[axis]);
            std::size_t const low = offsetof(WideNode, low) + std::size_t(axis) * kBvhWidth,
                              high = offsetof(WideNode, high) + std::size_t(axis) * kBvhWidth;
            near[axis] = r.inverse[axis] > 0 ? low : high;
            far[axis] = r.inverse[axis] > 0 ? high : low;
        }
    }
    std::uint32_t meet_children(WideNode const& node, float reach, float* enters) const
    {
        Eight const d;
        auto const* const bytes = reinterpret_cast<std::uint8_t const*>(&node);
        V8 first = hn::Set(d, ray.start), last = hn::Set(d, reach);
        for (int axis = 0; axis < 3; ++axis) {
            float const scale = node.step(axis) * ray.inverse[axis];
            V8 const from = hn::Set(d, (node.corner[axis] - ray.origin[axis]) * ray.inverse[axis]);
            V8 const steps = hn::Set(d, scale);
            first = hn::Max(first, hn::MulAdd(load_bytes(bytes + near[axis]), steps, from));
            last = hn::Min(last, hn::MulAdd(load_bytes(bytes + far[axis]), steps, from));
        }
        hn::Store(first, d, enters);
        return bits_of(d, hn::Le(first, hn::Mul(last, hn::Set(d, kBoxSlack)))) & ((1u << node.children) - 1);
    }
    template <class Accepts>
    void meet_leaf(Leaf const& leaf, BvhHit& hit, Accepts const& accepts) const
    {
        Four const d;
        auto const along = [&](int corner, int axis) {
            return hn::Sub(hn::Load(d, leaf.corner[3 * corner + axis]), origin[axis]);
        };
        RayShear const& s = ray.shear;
        V4 const az = along(0, s.z), bz = along(1, s.z), cz = along(2, s.z);
        V4 const ax = hn::NegMulAdd(shear_x, az, along(0, s.x)), ay = hn::NegMulAdd(shear_y, az, along(0, s.y));
        V4 const bx = hn::NegMulAdd(shear_x, bz, along(1, s.x)), by = hn::NegMulAdd(shear_y, bz, along(1, s.y));
        V4 const cx = hn::NegMulAdd(shear_x, cz, along(2, s.x)), cy = hn::NegMulAdd(shear_y, cz, along(2, s.y));
        auto const difference = [](V4 a, V4 b, V4 c, V4 d_) { // difference_of_products
            V4 const product = hn::Mul(c, d_), error = hn::MulSub(c, d_, product);
            return hn::Sub(hn::MulSub(a, b, product), error);
        };
        V4 const u = difference(cx, by, cy, bx), v = difference(ax, cy, ay, cx), w = difference(bx, ay, by, ax);
        V4 const zero = hn::Zero(d), sum = hn::Add(hn::Add(u, v), w);
        auto const apart =
            hn::And(hn::Lt(hn::Min(u, hn::Min(v, w)), zero), hn::Gt(hn::Max(u, hn::Max(v, w)), zero));
        auto const inside = hn::AndNot(apart, hn::Ne(sum, zero));
        if (hn::AllFalse(d, inside)) return;
        V4 const height = hn::MulAdd(u, az, hn::MulAdd(v, bz, hn::Mul(w, cz)));
        V4 const t = hn::Div(hn::Mul(height, hn::Set(d, s.scale_z)), sum);
        auto const met =
            hn::And(inside, hn::And(hn::Ge(t, hn::Set(d, ray.start)), hn::Le(t, hn::Set(d, hit.distance))));
        std::uint32_t bits = bits_of(d, met);
        if (bits == 0) return;
        alignas(16) float distances[4], weights_b[4], weights_c[4];
        hn::Store(t, d, distances);
        hn::Store(hn::Div(v, sum), d, weights_b);
        hn::Store(hn::Div(w, sum), d, weights_c);
        for (; bits != 0; bits &= bits - 1) {
            int const k = std::countr_zero(bits);
            std::uint32_t const triangle = leaf.triangle[k];
            if (triangle == kNoLeafTriangle || distances[k] > hit.distance ||
                (distances[k] == hit.distance && triangle >= hit.triangle))
                continue;
            vec2 const weights{weights_b[k], weights_c[k]};
            if (accepts(triangle, weights)) hit = {triangle, distances[k], weights};
        }
    }
};

} // namespace bvh_lanes

/// As trace_scalar. Nodes waiting on the stack are prefetched.
template <bool any, class Accepts>
void trace_lanes(BvhView const& bvh, BvhRay const& ray, BvhHit& hit, Accepts const& accepts)
{
    if (bvh.nodes.empty()) return;
    bvh_lanes::Lanes const lanes(ray);
    BvhEntry stack[kStackEntries];
    int top = 0;
    std::uint32_t at = 0;
    for (;;) {
        std::uint32_t met = 0;
        if ((at & kIsLeaf) == 0) {
            WideNode const& node = bvh.nodes[at];
            alignas(32) float enters[kBvhWidth];
            met = lanes.meet_children(node, hit.distance, enters);
            auto const entry = [&](int child) -> BvhEntry {
                std::uint32_t const k = std::uint32_t(child), index = node.child(k);
                bool const leaf = node.is_leaf(k);
                auto const* const bytes = leaf ? reinterpret_cast<char const*>(&bvh.leaves.data[index])
                                               : reinterpret_cast<char const*>(&bvh.nodes.data[index]);
                __builtin_prefetch(bytes);
                __builtin_prefetch(bytes + 64);
                if (leaf) __builtin_prefetch(bytes + 128);
                return {index | (leaf ? kIsLeaf : 0), any ? 0 : enters[child]};
            };
            if (met != 0) {
                BvhEntry nearest = entry(std::countr_zero(met));
                int const first = top;
                for (std::uint32_t bits = met & (met - 1); bits != 0; bits &= bits - 1) {
                    BvhEntry e = entry(std::countr_zero(bits));
                    if constexpr (any) { // any order will do; leaves are the first children
                        stack[top++] = e;
                        continue;
                    }
                    if (e.distance < nearest.distance) std::swap(e, nearest);
                    int to = top++;
                    for (; to > first && stack[to - 1].distance < e.distance; --to) stack[to] = stack[to - 1];
                    stack[to] = e;
                }
                at = nearest.at;
                continue;
            }
        } else {
            lanes.meet_leaf(bvh.leaves[at & ~kIsLeaf], hit, accepts);
            if (any && hit.triangle != kNoBvhTriangle) return;
        }
        do {
            if (top == 0) return;
            --top;
        } while (!any && stack[top].distance > hit.distance);
        at = stack[top].at;
    }
}

#else

template <bool any, class Accepts>
void trace_lanes(BvhView const& bvh, BvhRay const& ray, BvhHit& hit, Accepts const& accepts)
{
    trace_scalar<any>(bvh, ray, hit, accepts);
}

#endif

} // namespace gi
