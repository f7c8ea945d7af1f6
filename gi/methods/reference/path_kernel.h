#pragma once
// The path tracer as a kernel: one item traces one path of a pixel to its end, by exact rays through the project's
// own BVH. Steps and random numbers are those of PathTracer, so that both trace the same paths up to rounding.

#include "gi/kernel/atomics.h"
#include "gi/methods/reference/path_steps.h"
#include "gi/render/world_bvh.h"

namespace gi {

struct TraceReference {
    PathSteps steps;
    KernelRays rays;
    std::uint32_t pixels;      ///< of the picture, in rows of steps.width
    std::uint32_t first_path;  ///< of those traced now
    View<PathSample> samples;  ///< path by path, `pixels` each
    View<FirstHit> first_hits; ///< of the last path, per pixel; empty = not needed
    View<PathCounts> counts;   ///< one

    GI_FN void operator()(std::size_t i) const
    {
        auto const pixel = int(i % pixels);
        Path p = steps.start(pixel % steps.width, pixel / steps.width, first_path + std::uint32_t(i / pixels));
        PathCounts local;
        for (int vertex = 0; !p.ended; ++vertex) {
            Hit const hit = rays.nearest(steps.world, next_query(p, vertex));
            ++local.nearest_rays;
            if (hit.triangle != kNoTriangle && !steps.world.light_select.empty()) steps.choose_light(p);
            p.shadow_radiance = vec3{0};
            p.ended = !steps.advance(p, hit, vertex, local);
            if (!needs_shadow_ray(p)) continue;
            ++local.shadow_rays;
            if (!rays.occluded(steps.world, p.shadow)) add_noted_light(p);
        }
        local.invalid_paths += discard_invalid(p.sample);
        samples[i] = p.sample;
        if (!first_hits.empty() && i + pixels >= samples.size()) first_hits[std::size_t(pixel)] = p.first;
        add_counts(local);
    }

private:
    GI_FN void add_counts(PathCounts const& local) const
    {
        PathCounts& all = counts[0];
        atomic_add(all.nearest_rays, local.nearest_rays);
        if (local.shadow_rays > 0) atomic_add(all.shadow_rays, local.shadow_rays);
        if (local.cut_paths > 0) atomic_add(all.cut_paths, local.cut_paths);
        if (local.invalid_paths > 0) atomic_add(all.invalid_paths, local.invalid_paths);
    }
};

} // namespace gi
