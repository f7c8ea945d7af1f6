#pragma once
// Exact rays as kernels of their own: item = ray. They need fewer registers than a kernel that also shades, so
// that a device holds more of them at a time, and threads that step together all do the same (Laine et al. 2013,
// "Megakernels Considered Harmful").

#include "gi/kernel/columns.h"
#include "gi/render/world_bvh.h"

namespace gi {

/// A query that nothing answers.
GI_FN inline RayQuery no_query() { return {.ray = {}, .reach = 0}; }

struct NearestHits {
    WorldView world;
    KernelRays rays;
    ColumnView<RayQuery> queries;
    ColumnView<Hit> hits;

    GI_FN void operator()(std::size_t i) const
    {
        RayQuery const q = queries.load(i);
        if (q.reach > 0) hits.store(i, rays.nearest(world, q));
    }
};

template <bool panes>
struct ShadowRays {
    WorldView world;
    KernelRays rays;
    ColumnView<RayQuery> queries;
    ColumnView<vec3> left; ///< of the light, see KernelRays::transmittance

    GI_FN void operator()(std::size_t i) const
    {
        RayQuery const q = queries.load(i);
        if (q.reach > 0) left.store(i, rays.transmittance<panes>(world, q));
    }
};

} // namespace gi
