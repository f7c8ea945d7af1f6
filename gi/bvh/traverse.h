#pragma once
// Rays through a BVH, one at a time, for CPU and CUDA. traverse_lanes.h has the CPU's form in vectors; both find
// the same triangles.

#include "gi/bvh/bvh.h"
#include "gi/bvh/triangle_test.h"
#include "gi/scene/model/camera.h"

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

/// A stack entry of traversal.
struct BvhEntry {
    std::uint32_t node;
    float distance; ///< where the ray enters it
};
inline constexpr std::size_t kStackEntries = kDeepest * (kBvhWidth - 1) + 1;

/// Factor of the distances where rays leave boxes: exceeds the rounding of boxes that are far away. Near ones are
/// enlarged when they are built, see set_child_box.
inline constexpr float kBoxSlack = 1 + 0x1p-20f;

/// Tests the children's boxes. Returns a bit per child that the ray meets before `reach`; enters[k] = where.
GI_FN inline std::uint32_t meet_children(WideNode const& node, BvhRay const& ray, float reach,
                                         float enters[kBvhWidth])
{
    float scale[3], from[3];
    for (int axis = 0; axis < 3; ++axis) {
        scale[axis] = node.step(axis) * ray.inverse[axis];
        from[axis] = (node.corner[axis] - ray.origin[axis]) * ray.inverse[axis];
    }
    std::uint32_t hit = 0;
    for (int k = 0; k < kBvhWidth; ++k) {
        float near = ray.start, far = reach;
        for (int axis = 0; axis < 3; ++axis) {
            bool const up = ray.inverse[axis] > 0;
            float const first = float(up ? node.low[axis][k] : node.high[axis][k]),
                        second = float(up ? node.high[axis][k] : node.low[axis][k]);
            near = glm::max(near, std::fma(first, scale[axis], from[axis]));
            far = glm::min(far, std::fma(second, scale[axis], from[axis]));
        }
        enters[k] = near;
        if (near <= far * kBoxSlack) hit |= 1u << k;
    }
    return hit & ((1u << node.children) - 1);
}

/// Tests a leaf's triangles and updates the hit. @param accepts  (triangle, weights) -> whether the ray hits it
/// there, for surfaces that are partly transparent
template <class Accepts>
GI_FN void meet_leaf(Leaf const& leaf, BvhRay const& ray, BvhHit& hit, Accepts const& accepts)
{
    for (int k = 0; k < kLeafTriangles; ++k) {
        std::uint32_t const triangle = leaf.triangle[k];
        if (triangle == kNoLeafTriangle) return;
        vec3 corner[3];
        for (int c = 0; c < 3; ++c)
            for (int axis = 0; axis < 3; ++axis) corner[c][axis] = leaf.corner[3 * c + axis][k] - ray.origin[axis];
        TriangleHit const t = meet_triangle(corner[0], corner[1], corner[2], ray.shear, ray.start, hit.distance);
        if (t.distance == kInf || (t.distance == hit.distance && triangle >= hit.triangle)) continue;
        if (accepts(triangle, t.weights)) hit = {triangle, t.distance, t.weights};
    }
}

/// Finds the nearest triangle, or with `any` some triangle, nearer than hit.distance.
template <bool any, class Accepts>
GI_FN void trace_scalar(BvhView const& bvh, BvhRay const& ray, BvhHit& hit, Accepts const& accepts)
{
    if (bvh.nodes.empty()) return;
    BvhEntry stack[kStackEntries];
    int top = 0;
    stack[top++] = {0, ray.start};
    while (top > 0) {
        BvhEntry const at = stack[--top];
        if (at.distance > hit.distance) continue;
        WideNode const& node = bvh.nodes[at.node];
        float enters[kBvhWidth];
        std::uint32_t const met = meet_children(node, ray, hit.distance, enters);
        int const first = top; // the nearest on top
        for (std::uint32_t k = 0; k < node.children; ++k) {
            if ((met & (1u << k)) == 0) continue;
            if (node.is_leaf(k)) {
                meet_leaf(bvh.leaves[node.child(k)], ray, hit, accepts);
                if (any && hit.triangle != kNoBvhTriangle) return;
                continue;
            }
            BvhEntry const e{node.child(k), enters[k]};
            int to = top++;
            for (; to > first && stack[to - 1].distance < e.distance; --to) stack[to] = stack[to - 1];
            stack[to] = e;
        }
    }
}

} // namespace gi
