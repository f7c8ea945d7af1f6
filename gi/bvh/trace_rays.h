#pragma once
// Rays through BVHs as a kernel: one item traces one ray, in the static tree and then in the dynamic one.

#include "gi/bvh/traverse.h"

namespace gi {

struct BvhQuery {
    Ray ray;
    float start, reach; ///< m; nearer and farther surfaces are ignored
};

/// @tparam any  whether any triangle will do instead of the nearest
template <bool any>
struct TraceRays {
    View<BvhQuery const> queries;
    BvhView trees[2]; ///< the second may be empty
    View<BvhHit> hits;

    GI_FN void operator()(std::size_t i) const
    {
        BvhRay const ray(queries[i].ray, queries[i].start);
        BvhHit hit;
        hit.distance = queries[i].reach;
        auto const accepts = [](std::uint32_t, vec2) { return true; };
        // One traversal in the code; trees are not indexed, as a device would copy them to local memory.
#pragma unroll 1
        for (int k = 0; k < 2; ++k) {
            BvhView const tree = k == 0 ? trees[0] : trees[1];
            if (!any || hit.triangle == kNoBvhTriangle) trace_scalar<any>(tree, ray, hit, accepts);
        }
        hits[i] = hit;
    }
};

} // namespace gi
