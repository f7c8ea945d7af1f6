#pragma once
// The path tracer as a kernel, by exact rays through the project's own BVH: one item, a worker, traces some paths
// one after the other. Where a path ends the next one begins at once, so that the threads of a device that step
// together do not wait for the longest path (Novak et al. 2010). Steps and random numbers are those of PathTracer,
// so that both trace the same paths up to rounding.

#include "gi/kernel/atomics.h"
#include "gi/methods/reference/path_steps.h"
#include "gi/render/add_samples.h"
#include "gi/render/world_bvh.h"

namespace gi {

/// Keeps samples, one per pixel: the last one.
struct KeepSamples {
    View<PathSample> samples;

    GI_FN void add(std::size_t pixel, std::uint32_t, PathSample const& s) const { samples[pixel] = s; }
};

template <class Samples>
struct TraceReference {
    PathSteps steps;
    KernelRays rays;
    std::uint32_t pixels;     ///< of the picture, in rows of steps.width
    std::uint32_t first_path; ///< of those traced now
    std::uint32_t paths;      ///< of each pixel
    std::size_t workers;      ///< number of items
    Samples samples;
    View<FirstHit> first_hits; ///< of the last path, per pixel; empty = not needed
    View<PathCounts> counts;   ///< to be added up

    GI_FN void operator()(std::size_t worker) const
    {
        PathCounts local;
        std::size_t pixel = worker;
        std::uint32_t path = 0;
        Path p = start(pixel, path);
        for (int vertex = 0;;) {
            step(p, vertex, local);
            if (!p.ended) {
                ++vertex;
                continue;
            }
            local.invalid_paths += discard_invalid(p.sample);
            samples.add(pixel, path, p.sample);
            if (++path == paths) {
                if (!first_hits.empty()) first_hits[pixel] = p.first;
                path = 0;
                pixel += workers;
                if (pixel >= pixels) break;
            }
            p = start(pixel, path);
            vertex = 0;
        }
        add_counts(worker, local);
    }

private:
    GI_FN Path start(std::size_t pixel, std::uint32_t path) const
    {
        return steps.start(int(pixel) % steps.width, int(pixel) / steps.width, first_path + path);
    }
    /// From one surface to the next, and the light there.
    GI_FN void step(Path& p, int vertex, PathCounts& local) const
    {
        Hit const hit = rays.nearest(steps.world, next_query(p, vertex));
        ++local.nearest_rays;
        if (hit.triangle != kNoTriangle && !steps.world.light_select.empty()) steps.choose_light(p);
        p.shadow_radiance = vec3{0};
        p.ended = !steps.advance(p, hit, vertex, local);
        if (!needs_shadow_ray(p)) return;
        ++local.shadow_rays;
        if (!rays.occluded(steps.world, p.shadow)) add_noted_light(p);
    }
    GI_FN void add_counts(std::size_t item, PathCounts const& local) const
    {
        PathCounts& all = counts[item % counts.size()];
        atomic_add(all.nearest_rays, local.nearest_rays);
        if (local.shadow_rays > 0) atomic_add(all.shadow_rays, local.shadow_rays);
        if (local.cut_paths > 0) atomic_add(all.cut_paths, local.cut_paths);
        if (local.invalid_paths > 0) atomic_add(all.invalid_paths, local.invalid_paths);
    }
};

} // namespace gi
