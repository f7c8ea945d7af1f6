#pragma once
// Paths of exact rays on the CPU. They advance together, one surface at a time: all nearest hits, then all
// scatterings, then all shadow rays. So rays are traced in packets, and work on one path hides the cache misses of
// another. Each path has its own random stream; the grouping depends only on the tile, not on threads.

#include "gi/render/ray_path.h"

#include <span>
#include <vector>

namespace gi {

/// Prefetches the vertex data to which a surface refers.
inline void prefetch_vertices(WorldView const& world, Surface const& s)
{
    for (int k = 0; k < 3; ++k) {
        if (s.is(Surface::kSmooth)) __builtin_prefetch(&world.normals[s.vertex[k]]);
        if (s.is(Surface::kVaries) && !world.uv0.empty()) __builtin_prefetch(&world.uv0[s.vertex[k]]);
    }
}

/// Traces the shadow rays of many paths together and adds the light of the unblocked ones.
template <class Path, class Visibility>
void add_unshadowed(std::span<Path* const> paths, Visibility const& visibility, PathCounts& counts)
{
    std::vector<Path*> waiting;
    std::vector<RayQuery> queries;
    for (Path* p : paths) {
        if (!needs_shadow_ray(*p)) continue;
        waiting.push_back(p);
        queries.push_back(p->shadow);
    }
    counts.shadow_rays += waiting.size();
    std::vector<vec3> left(waiting.size());
    visibility.transmittance(queries, left);
    for (std::size_t i = 0; i < waiting.size(); ++i) {
        if (left[i] == vec3{0}) continue;
        waiting[i]->shadow_radiance *= left[i];
        add_noted_light(*waiting[i]);
    }
}

/// Traces all paths to their ends.
/// @tparam Path        derived from RayPath
/// @tparam Visibility  provides nearest(queries, hits) and transmittance(queries, left) like ExactVisibility
/// @param prepare  (active paths, their hits), before each step
/// @param advance  (path, hit, number of surfaces before) -> whether the path continues with the ray that it set
template <class Path, class Visibility, class Prepare, class Advance>
void trace_together(std::span<Path> paths, WorldView const& world, Visibility const& visibility,
                    PathCounts& counts, Prepare const& prepare, Advance const& advance)
{
    std::vector<Path*> active;
    std::vector<RayQuery> queries(paths.size());
    std::vector<Hit> hits(paths.size());
    for (Path& p : paths) active.push_back(&p);
    for (int vertex = 0; !active.empty(); ++vertex) {
        std::size_t const n = active.size();
        counts.nearest_rays += n;
        for (std::size_t i = 0; i < n; ++i) queries[i] = next_query(*active[i], vertex);
        std::span<Hit> const found = std::span(hits).first(n);
        visibility.nearest(std::span(queries).first(n), found);
        prepare(std::span<Path* const>(active), std::span<Hit const>(found));
        // First the surface, and a few paths later the data to which it refers.
        constexpr std::size_t kAhead = 4;
        auto const surface = [&](std::size_t i) -> Surface const* {
            return i < n && found[i].triangle != kNoTriangle ? &world.surfaces[found[i].triangle] : nullptr;
        };
        for (std::size_t i = 0; i < n; ++i) {
            if (Surface const* const s = surface(i + 2 * kAhead)) __builtin_prefetch(s);
            if (Surface const* const s = surface(i + kAhead)) prefetch_vertices(world, *s);
            active[i]->shadow_radiance = vec3{0};
            active[i]->ended = !advance(*active[i], found[i], vertex);
        }
        add_unshadowed(std::span<Path* const>(active), visibility, counts);
        std::erase_if(active, [](Path const* p) { return p->ended; });
    }
    for (Path& p : paths) counts.invalid_paths += discard_invalid(p.sample);
}

} // namespace gi
