#pragma once
// Exact rays as kernels of their own: item = ray. They need fewer registers than a kernel that also shades, so
// that a device holds more of them at a time, and threads that step together all do the same (Laine et al. 2013,
// "Megakernels Considered Harmful").

#include "gi/kernel/columns.h"
#include "gi/render/world_bvh.h"

namespace gi {

/// A query that nothing answers.
GI_FN inline RayQuery no_query() { return {.ray = {}, .reach = 0}; }

/// The nearest hits of as many queries, then what is left of the light along as many shadow rays: in one launch, so
/// that a device is not left idle between them.
template <bool panes>
struct RaysOfPaths {
    WorldView world;
    KernelRays rays;
    ColumnView<RayQuery> queries, shadows;
    ColumnView<Hit> hits;
    ColumnView<vec3> left; ///< see KernelRays::transmittance

    GI_FN void operator()(std::size_t item) const
    {
        bool const asks_for_light = item >= queries.count;
        std::size_t const i = asks_for_light ? item - queries.count : item;
        RayQuery const q = asks_for_light ? shadows.load(i) : queries.load(i);
        if (!(q.reach > 0)) return;
        if (asks_for_light)
            left.store(i, rays.transmittance<panes>(world, q));
        else
            hits.store(i, rays.nearest(world, q));
    }
};

} // namespace gi
