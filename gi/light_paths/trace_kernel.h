#pragma once
// Light paths as a kernel: one item traces one path to its end, by exact rays through the project's own BVH. Steps
// and random numbers are those of trace_light_paths(), so that both trace the same paths up to rounding. It is for
// devices: the methods trace their paths on the CPU, by trace_light_paths(), and tests compare the two.

#include "gi/kernel/atomics.h"
#include "gi/light_paths/light_path_step.h"
#include "gi/render/path_sample.h"
#include "gi/render/world_bvh.h"

namespace gi {

struct TraceLightPaths {
    WorldView world;
    Bounds bounds; ///< of the world
    KernelRays rays;
    LightPathSet set;
    LightPathRules rules;
    std::uint32_t first;        ///< path of item 0
    std::uint32_t slots;        ///< vertices of a path that are kept
    View<LightVertex> vertices; ///< path by path, `slots` each
    View<std::uint32_t> counts; ///< per path: its vertices, also those that are not kept

    GI_FN void operator()(std::size_t i) const
    {
        LightPath p;
        start_at_light(world, bounds, set, first + std::uint32_t(i), p);
        std::uint32_t found = 0;
        bool goes_on = max_component(p.light.power) > 0;
        for (int surface = 0; goes_on && surface < kLongestPath; ++surface) {
            Hit const hit = rays.nearest(world, {.ray = p.light.ray, .seed = p.rng.next()});
            LightVertex vertex;
            bool has_vertex = false;
            goes_on = advance(
                world, rules, p, hit, [](vec3, std::uint32_t) { return true; }, vertex, has_vertex);
            if (!has_vertex) continue;
            if (found < slots) vertices[i * slots + found] = vertex;
            ++found;
        }
        counts[i] = found;
    }
};

} // namespace gi
