#pragma once
// The path tracer on the CPU: many paths together, see gi/render/path_batch.h. The estimator: path_steps.h.

#include "gi/light_paths/photon_map.h"
#include "gi/methods/reference/path_steps.h"
#include "gi/render/path_batch.h"

namespace gi {

/// @tparam Visibility  see trace_together
template <class Visibility>
struct PathTracer {
    PathSteps steps;
    Visibility const& visibility;
    PhotonMap const* caustics = nullptr; ///< of lamps; null = none

    /// Traces all paths to their ends.
    void trace(std::span<Path> paths, PathCounts& counts) const
    {
        trace_together(
            paths, steps.world, visibility, counts,
            [&](std::span<Path* const> active, std::span<Hit const> hits) { choose_lights(active, hits); },
            [&](Path& p, Hit const& hit, int vertex) { return advance(p, hit, vertex, counts); });
    }

private:
    /// Flattened into one function, so that vectors stay in registers:
    /// measured to save 3 to 16 % of a path's time.
    [[gnu::flatten]] bool advance(Path& p, Hit const& hit, int vertex, PathCounts& counts) const
    {
        return steps.advance(p, hit, vertex, counts, [this](Path& path, ShadingPoint const& at, vec3 wo) {
            if (caustics == nullptr) return;
            add_light(path.sample, path.scatterings + 1, path.throughput * caustics->radiance(at, wo, false));
        });
    }
    void choose_lights(std::span<Path* const> paths, std::span<Hit const> hits) const;
};

/// In a separate loop, so that the cache misses of many choices overlap: the tables of a sky are large.
template <class Visibility>
void PathTracer<Visibility>::choose_lights(std::span<Path* const> paths, std::span<Hit const> hits) const
{
    WorldView const& world = steps.world;
    if (world.light_select.empty()) return;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (hits[i].triangle == kNoTriangle) continue;
        steps.choose_light(*paths[i]);
        LightChoice const& choice = paths[i]->light;
        if (!light_detail::is_environment(world, choice)) continue;
        vec3 const* const texel = &world.environment_radiance[choice.texel]; // the sample lies within half a texel
        std::size_t const row = world.environment_width;
        __builtin_prefetch(texel);
        if (choice.texel >= row) __builtin_prefetch(texel - row);
        if (choice.texel + row < world.environment_radiance.size()) __builtin_prefetch(texel + row);
    }
}

} // namespace gi
