#pragma once
// Rays through a BVH, one at a time, for CPU and CUDA.

#include "gi/bvh/bvh.h"
#include "gi/bvh/triangle_test.h"
#include "gi/kernel/device_code.h"
#include "gi/scene/model/camera.h"

#include <bit>

namespace gi {

inline constexpr std::uint32_t kNoBvhTriangle = 0xffffffffu;

/// The nearest triangle so far. Of triangles at the same distance, the one with the lowest index counts.
struct BvhHit {
    std::uint32_t triangle = kNoBvhTriangle;
    float distance = kInf; ///< at first the ray's reach; farther triangles are ignored
    vec2 weights{0};       ///< of corners 1 and 2
};

/// A ray as box tests need it.
struct BvhRay {
    vec3 origin, direction, inverse;
    float start; ///< nearer triangles are ignored
    RayShear shear;

    GI_FN BvhRay(Ray const& ray, float start_)
        : origin(ray.origin), direction(ray.direction), start(start_), shear(ray.direction)
    {
        // Limited, so that products with distances up to kFarthest stay finite.
        constexpr float kSmallest = 1e-19f;
        for (int axis = 0; axis < 3; ++axis) {
            float const d = direction[axis];
            inverse[axis] = 1 / (std::abs(d) < kSmallest ? std::copysign(kSmallest, d) : d);
        }
    }
};

/// A stack entry of traversal: children of a node that are still to be visited (Ylitie, Karras and Laine 2017). One per
/// level of the tree, where an entry per child would take three times the memory of a device's threads.
struct BvhGroup {
    std::uint32_t first_node, first_leaf; ///< as in the node
    std::uint32_t children;               ///< bits 0 to 7: those to visit; from bit 8 on: how many are leaves
    float distance;                       ///< where the ray enters the nearest of them
};
inline constexpr std::uint32_t kIsLeaf = 0x80000000u;

/// Factor of the distances where rays leave boxes: exceeds the rounding of boxes that are far away. Near ones are
/// enlarged when they are built, see set_child_box.
inline constexpr float kBoxSlack = 1 + 0x1p-20f;

/// What a ray meets of a node's children.
struct MetChildren {
    std::uint32_t bits = 0; ///< of children
    float enters[kBvhWidth];
    std::uint32_t first_node, first_leaf, leaves; ///< as in the node

    GI_FN std::uint32_t child(std::uint32_t k) const
    {
        return k < leaves ? kIsLeaf | (first_leaf + k) : first_node + k - leaves;
    }
};

/// Tests the children's boxes. @param reach  farther ones are not met
GI_FN inline MetChildren meet_children(WideNode const& node, BvhRay const& ray, float reach)
{
    FourWords const w0 = load_words(&node, 0), w1 = load_words(&node, 1), w2 = load_words(&node, 2),
                    w3 = load_words(&node, 3), w4 = load_words(&node, 4);
    MetChildren met;
    met.first_node = w1.word[0];
    met.first_leaf = w1.word[1];
    met.leaves = w1.word[2];
    // Two words of bytes per axis, of the low and of the high planes.
    std::uint32_t const low[3][2] = {{w2.word[0], w2.word[1]}, {w2.word[2], w2.word[3]}, {w3.word[0], w3.word[1]}},
                        high[3][2] = {
                            {w3.word[2], w3.word[3]}, {w4.word[0], w4.word[1]}, {w4.word[2], w4.word[3]}};
    float scale[3], from[3];
    std::uint32_t near[3][2], far[3][2];
    for (int axis = 0; axis < 3; ++axis) {
        float const step = std::bit_cast<float>((w0.word[3] >> (8 * axis) & 0xffu) << 23);
        scale[axis] = step * ray.inverse[axis];
        from[axis] = (std::bit_cast<float>(w0.word[axis]) - ray.origin[axis]) * ray.inverse[axis];
        bool const up = ray.inverse[axis] > 0;
        for (int half = 0; half < 2; ++half) {
            near[axis][half] = up ? low[axis][half] : high[axis][half];
            far[axis][half] = up ? high[axis][half] : low[axis][half];
        }
    }
    for (int k = 0; k < kBvhWidth; ++k) {
        float enters = ray.start, exits = reach;
        for (int axis = 0; axis < 3; ++axis) {
            int const shift = 8 * (k % 4);
            enters = larger(enters, std::fma(float(near[axis][k / 4] >> shift & 0xffu), scale[axis], from[axis]));
            exits = smaller(exits, std::fma(float(far[axis][k / 4] >> shift & 0xffu), scale[axis], from[axis]));
        }
        met.enters[k] = enters;
        if (enters <= exits * kBoxSlack) met.bits |= 1u << k;
    }
    met.bits &= (1u << (w0.word[3] >> 24)) - 1; // their number
    return met;
}

/// Tests a leaf's triangles and updates the hit. @param accepts  (triangle, weights) -> whether the ray hits it
/// there, for surfaces that are partly transparent
template <class Accepts>
GI_FN void meet_leaf(Leaf const& leaf, BvhRay const& ray, BvhHit& hit, Accepts const& accepts)
{
    RayShear const& s = ray.shear;
    vec3 const origin{ray.origin[s.x], ray.origin[s.y], ray.origin[s.z]};
    // Triangle by triangle, as an array of all would lie in a device's local memory.
#pragma unroll 1
    for (int k = 0; k < kLeafTriangles; ++k) {
        std::uint32_t const triangle = leaf.triangle[k];
        if (triangle == kNoLeafTriangle) return;
        vec3 corner[3];
        for (int c = 0; c < 3; ++c)
            corner[c] =
                vec3{leaf.corner[3 * c + s.x][k], leaf.corner[3 * c + s.y][k], leaf.corner[3 * c + s.z][k]} -
                origin;
        TriangleHit const t = meet_sheared(corner[0], corner[1], corner[2], s, ray.start, hit.distance);
        if (t.distance == kInf || (t.distance == hit.distance && triangle >= hit.triangle)) continue;
        if (accepts(triangle, t.weights)) hit = {triangle, t.distance, t.weights};
    }
}

/// Takes the next child from a stack of groups; kNoBvhTriangle if there is none. @param top  number of groups
template <bool any>
GI_FN std::uint32_t pop_child(BvhGroup* stack, int& top, float reach)
{
    while (top > 0) {
        BvhGroup& group = stack[top - 1];
        if (!any && group.distance > reach) {
            --top;
            continue;
        }
        auto const k = lowest_bit(group.children), leaves = group.children >> 8;
        std::uint32_t const child = k < leaves ? kIsLeaf | (group.first_leaf + k) : group.first_node + k - leaves;
        group.children &= group.children - 1;
        if ((group.children & 0xffu) == 0) --top;
        return child;
    }
    return kNoBvhTriangle;
}

/// Finds the nearest triangle, or with `any` some triangle, nearer than hit.distance. The nearest child first, the
/// others in no order: sorting them would cost a device more than it saves.
template <bool any, class Accepts>
GI_FN void trace_scalar(BvhView const& bvh, BvhRay const& ray, BvhHit& hit, Accepts const& accepts)
{
    if (bvh.nodes.empty()) return;
    BvhGroup stack[kDeepest];
    int top = 0;
    std::uint32_t at = 0;
    // Walks inner nodes in a loop of their own, so that the threads of a warp reach leaves together.
    for (;;) {
        while ((at & kIsLeaf) == 0) {
            MetChildren const met = meet_children(bvh.nodes[at], ray, hit.distance);
            if (met.bits == 0) {
                at = pop_child<any>(stack, top, hit.distance);
                continue;
            }
            std::uint32_t nearest = kBvhWidth;
            float distance = kInf, others = kInf;
            // Unrolled, so that arrays stay in registers.
#pragma unroll
            for (std::uint32_t k = 0; k < kBvhWidth; ++k) {
                if ((met.bits >> k & 1) == 0) continue;
                float const enters = met.enters[k];
                if (nearest == kBvhWidth || (!any && enters < distance)) {
                    others = smaller(others, distance);
                    nearest = k;
                    distance = enters;
                } else {
                    others = smaller(others, enters);
                }
            }
            if (std::uint32_t const rest = met.bits & ~(1u << nearest); rest != 0)
                stack[top++] = {met.first_node, met.first_leaf, rest | met.leaves << 8, others};
            at = met.child(nearest);
        }
        if (at == kNoBvhTriangle) return;
        meet_leaf(bvh.leaves[at & ~kIsLeaf], ray, hit, accepts);
        if (any && hit.triangle != kNoBvhTriangle) return;
        at = pop_child<any>(stack, top, hit.distance);
    }
}

} // namespace gi
