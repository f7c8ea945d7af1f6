#pragma once
// Paths whose segments are exact rays. They advance together, one surface at a time: all nearest hits, then all
// scatterings, then all shadow rays. So rays are traced in packets, and work on one path hides the cache misses of
// another. Each path has its own random stream; the grouping depends only on the tile, not on threads.

#include "gi/core/rng.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/path_step.h"
#include "gi/scene/shading/warp.h"

#include <span>
#include <vector>

namespace gi {

/// First surface of a path from the camera.
struct FirstHit {
    std::uint32_t triangle = kNoTriangle;
    vec2 weights{0}; ///< of corners 1 and 2
};

struct RayPath : PathState {
    Pcg32 rng{0, 0};
    Ray ray;
    bool ended = false;
    RayQuery shadow;
    int shadow_scatterings = 0; ///< of its light, see layer_of
    vec3 shadow_radiance{0};    ///< radiance that arrives if unblocked; 0 = no shadow ray needed
    PathSample sample;
};

/// Separate, so that it does not affect the rounding of pinhole rays.
[[gnu::noinline]] inline Ray lens_ray(CameraRays const& camera, vec2 place, vec2 u)
{
    return camera.at_lens(square_to_disk(u)).through(place);
}

/// Ray through a point of the image plane (px) and a random point of the lens. @param u  () -> uniform in [0, 1)^2
template <class Uniform2>
Ray camera_ray(CameraRays const& camera, vec2 place, Uniform2 const& u)
{
    return camera.has_lens() ? lens_ray(camera, place, u()) : camera.through(place);
}

/// Starts path number `index` of pixel (x, y) at the camera.
inline void start_path(RayPath& p, CameraRays const& camera, PixelFilter filter, std::uint64_t seed, glm::ivec2 at,
                       int width, std::uint32_t index)
{
    p.rng = Pcg32::for_path(seed, std::uint32_t(at.y) * std::uint32_t(width) + std::uint32_t(at.x), index);
    vec2 const place = vec2{float(at.x) + 0.5f, float(at.y) + 0.5f} + filter_offset(filter, p.rng.uniform2());
    p.ray = camera_ray(camera, place, [&] { return p.rng.uniform2(); });
}

/// Adds the light of the environment to a path that hits nothing. @param vertex  number of surfaces before
inline void add_environment(WorldView const& world, RayPath& p, int vertex)
{
    if (vertex == 0)
        p.sample.radiance[0] = background_radiance(world, p.ray.direction);
    else if (!world.environment_radiance.empty())
        layer_of(p.sample, p.scatterings) += p.throughput * met_environment(world, p, p.ray.direction);
}

/// Shadow ray from a surface to just before a light; reach <= 0 if the light lies on the surface.
inline RayQuery shadow_ray(vec3 position, vec3 normal, float clearance, LightSample const& light)
{
    float const side = glm::dot(light.direction, normal) > 0 ? clearance : -clearance;
    RayQuery q{.ray = {position + side * normal, light.direction}, .reach = light.distance};
    if (light.distance == kInf) return q;
    // Aims from the ray's start, and ends before the light's own surface by more than the rounding of both ends.
    vec3 const way = position + light.distance * light.direction - q.ray.origin;
    float const length = glm::length(way);
    q.ray.direction = way * (1 / length);
    q.reach = length * (1 - 2e-5f) - clearance;
    return q;
}

/// Notes a light sample's radiance for the path's shadow ray.
inline void aim_at_light(RayPath& p, ShadingPoint const& at, LightSample const& light, vec3 unshadowed)
{
    if (!(max_component(unshadowed) > 0)) return;
    p.shadow_radiance = p.throughput * unshadowed;
    p.shadow_scatterings = p.scatterings + 1;
    p.shadow = shadow_ray(at.position, at.geometric_normal, at.clearance, light);
}

/// Continues a path along a sampled direction. Returns false if it ends.
inline bool continue_path(RayPath& p, ShadingPoint const& at, BsdfSample const& next)
{
    if (!survives_roulette(p, 0, [&] { return p.rng.uniform(); })) return false;
    vec3 const direction = at.frame.to_world(next.wi);
    if (!is_on_one_side(at, direction, next.wi)) return false;
    p.ray = {leave(at, direction), direction};
    p.arrival_pdf = next.delta ? 0 : next.pdf;
    if (!next.delta) ++p.scatterings;
    return true;
}

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
        if (!(max_component(p->shadow_radiance) > 0)) continue;
        if (!(p->shadow.reach > 0)) { // the light lies on the surface
            layer_of(p->sample, p->shadow_scatterings) += p->shadow_radiance;
            continue;
        }
        p->shadow.seed = p->rng.next();
        waiting.push_back(p);
        queries.push_back(p->shadow);
    }
    counts.shadow_rays += waiting.size();
    std::vector<std::uint8_t> blocked(waiting.size());
    visibility.occluded(queries, blocked);
    for (std::size_t i = 0; i < waiting.size(); ++i)
        if (blocked[i] == 0)
            layer_of(waiting[i]->sample, waiting[i]->shadow_scatterings) += waiting[i]->shadow_radiance;
}

/// Traces all paths to their ends.
/// @tparam Path        derived from RayPath
/// @tparam Visibility  provides nearest(queries, hits) and occluded(queries, blocked) like ExactVisibility
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
        for (std::size_t i = 0; i < n; ++i) {
            queries[i] = {.ray = active[i]->ray, .seed = active[i]->rng.next()};
            if (vertex == 0) queries[i].start = camera_clearance(queries[i].ray.origin);
        }
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
