#pragma once
// Path tracing: next-event estimation and BSDF sampling combined with the power heuristic (Veach 1997,
// sec. 9.2.4), Russian roulette on throughput. The estimator is unbiased except for the limit on bounces; nothing
// is clamped.
//
// Paths advance together, one surface at a time: all nearest hits, then all scatterings, then all shadow rays. So
// rays are traced in packets, and work on one path hides the cache misses of another. Each path has its own
// random stream; the grouping depends only on the tile, not on threads.
//
// Light is sorted by the number of non-delta scatterings between the light and the eye: L0 emitted light seen
// directly (also through mirrors and glass), L1 direct light, L2 all indirect light.

#include "gi/core/rng.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/interleaving.h"
#include "gi/render/path_sample.h"
#include "gi/render/sampling.h"
#include "gi/render/shadow_rays.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/shading/light_sampling.h"
#include "gi/scene/shading/narrow_lobes.h"
#include "gi/scene/shading/shading_point.h"
#include "gi/scene/shading/warp.h"

#include <span>
#include <utility>
#include <vector>

namespace gi {

/// Size of the tiles whose paths advance together, px.
inline constexpr int kTile = 16;

/// State of one path.
struct Path {
    Pcg32 rng{0, 0};
    Ray ray;
    vec3 throughput{1};
    /// Probability density of the arrival direction; 0 = camera or delta lobe, which no other technique samples.
    float arrival_pdf = 0;
    int scatterings = 0; ///< non-delta, so far
    LightChoice light;   ///< chosen for the next surface
    bool ended = false;
    bool emitted = false;    ///< emission of the next surface or sky has already been counted
    std::uint32_t share = 1; ///< number of pixels for which it computes indirect light, see Interleaving
    RayQuery shadow;
    int shadow_bucket = 0;
    vec3 shadow_radiance{0}; ///< radiance that arrives if unblocked; 0 = no shadow ray needed
    PathSample sample;
    std::uint32_t first_triangle = kNoTriangle; ///< triangle seen by the camera
    vec2 first_weights{0};                      ///< hit point on it: weights of corners 1 and 2

    vec3& bucket(int scattered) { return sample.radiance[std::size_t(std::min(scattered, 2))]; }
};

/// @tparam Visibility provides nearest(queries, hits) and occluded(queries, blocked) like ExactVisibility
template <class Visibility>
struct PathTracer {
    WorldView world;
    Visibility const& visibility;
    CameraRays camera;
    int bounces;
    std::uint64_t seed;
    PixelFilter filter;
    int width;
    Interleaving interleaving{};

    /// Starts path number `index` of pixel (x, y) at the camera.
    Path start(int x, int y, std::uint32_t index) const
    {
        Path p;
        std::uint32_t const pixel = std::uint32_t(y) * std::uint32_t(width) + std::uint32_t(x);
        p.rng = Pcg32::for_path(seed, pixel, index);
        if (interleaving.n > 1) p.share = interleaving.share(pixel, std::uint32_t(width), index);
        vec2 const place = vec2{float(x) + 0.5f, float(y) + 0.5f} + filter_offset(filter, p.rng.uniform2());
        p.ray = camera.through(place);
        if (camera.has_lens()) look_through_lens(place, p);
        return p;
    }
    /// Traces all paths to their ends.
    void trace(std::span<Path> paths, PathCounts& counts) const;

private:
    /// Separate, so that it does not affect the rounding of pinhole rays.
    [[gnu::noinline]] void look_through_lens(vec2 place, Path& p) const
    {
        p.ray = camera.at_lens(square_to_disk(p.rng.uniform2())).through(place);
    }
    static vec3 leave(ShadingPoint const& at, vec3 direction)
    {
        float const offset = glm::dot(direction, at.geometric_normal) > 0 ? at.clearance : -at.clearance;
        return at.position + offset * at.geometric_normal;
    }
    /// Prefetches shading data: first the surface, and a few paths later the data to which it refers.
    void fetch_surface(Hit const& hit) const
    {
        if (hit.triangle != kNoTriangle) __builtin_prefetch(&world.surfaces[hit.triangle]);
    }
    void fetch_vertices(Hit const& hit) const
    {
        if (hit.triangle == kNoTriangle) return;
        Surface const& s = world.surfaces[hit.triangle];
        for (int k = 0; k < 3; ++k) {
            if (s.is(Surface::kSmooth)) __builtin_prefetch(&world.normals[s.vertex[k]]);
            if (s.is(Surface::kVaries) && !world.uv0.empty()) __builtin_prefetch(&world.uv0[s.vertex[k]]);
        }
    }
    void collect_environment(Path& p) const;
    void collect_emission(Path& p, Hit const& hit, ShadingPoint const& at) const;
    /// @param alone  no path continues that could hit the light
    void aim_at_light(Path& p, ShadingPoint const& at, vec3 wo, bool alone) const;
    /// Flattened into one function, so that vectors stay in registers: measured to save 3 to 16 % of a path's
    /// time.
    [[gnu::flatten]] bool advance(Path& p, Hit const& hit, int vertex, PathCounts& counts) const;
    void choose_lights(std::span<Path* const> paths, std::span<Hit const> hits) const;
};

template <class Visibility>
void PathTracer<Visibility>::collect_environment(Path& p) const
{
    if (world.environment_radiance.empty() || p.emitted) return;
    vec3 light = environment_radiance(world, p.ray.direction);
    if (p.arrival_pdf > 0)
        light *= power_heuristic(p.arrival_pdf, environment_direction_pdf(world, p.ray.direction));
    p.bucket(p.scatterings) += p.throughput * light;
}

template <class Visibility>
void PathTracer<Visibility>::collect_emission(Path& p, Hit const& hit, ShadingPoint const& at) const
{
    vec3 light = at.emission;
    if (p.arrival_pdf > 0) {
        float const cos_light = std::abs(glm::dot(p.ray.direction, at.geometric_normal));
        light *=
            power_heuristic(p.arrival_pdf, emitter_direction_pdf(world, hit.triangle, hit.distance, cos_light));
    }
    p.bucket(p.scatterings) += p.throughput * light;
}

template <class Visibility>
void PathTracer<Visibility>::aim_at_light(Path& p, ShadingPoint const& at, vec3 wo, bool alone) const
{
    LightSample const light = sample_light(world, p.light, at.position, p.rng.uniform2());
    if (!(light.pdf > 0)) return;
    vec3 const wi = at.frame.to_local(light.direction);
    if ((wi.z > 0) != (glm::dot(light.direction, at.geometric_normal) > 0)) return;
    BsdfValue const bsdf = evaluate(at.bsdf, wo, wi);
    vec3 value = bsdf.f * light.radiance * (std::abs(wi.z) / light.pdf);
    if (!(max_component(value) > 0)) return;
    if (!light.delta && !alone) value *= power_heuristic(light.pdf, bsdf.pdf);

    p.shadow_radiance = p.throughput * value;
    p.shadow_bucket = p.scatterings + 1;
    p.shadow.ray = {leave(at, light.direction), light.direction};
    p.shadow.reach = light.distance;
    if (light.distance == kInf) return;
    // Aims from the ray's start, and ends before the light's own surface by more than the rounding of both ends.
    vec3 const way = at.position + light.distance * light.direction - p.shadow.ray.origin;
    float const length = glm::length(way);
    p.shadow.ray.direction = way * (1 / length);
    p.shadow.reach = length * (1 - 2e-5f) - at.clearance;
}

/// Advances from a hit to the next ray. Returns false if the path ends.
template <class Visibility>
bool PathTracer<Visibility>::advance(Path& p, Hit const& hit, int vertex, PathCounts& counts) const
{
    p.shadow_radiance = vec3{0};
    if (hit.triangle == kNoTriangle) {
        if (vertex == 0)
            p.sample.radiance[0] = background_radiance(world, p.ray.direction);
        else
            collect_environment(p);
        return false;
    }
    ShadingPoint const at = shading_point(world, hit.triangle, hit.barycentric, p.ray.direction);
    if (vertex == 0) {
        p.sample.hit = true;
        p.first_triangle = hit.triangle;
        p.first_weights = hit.barycentric;
        p.sample.albedo = albedo(at.bsdf);
        p.sample.normal = at.frame.normal;
        p.sample.position = at.position;
        p.sample.depth = glm::dot(at.position - camera.origin, camera.forward);
    }
    if (!std::exchange(p.emitted, false) && max_component(at.emission) > 0) collect_emission(p, hit, at);
    if (vertex == kLongestPath) {
        ++counts.cut_paths;
        return false;
    }

    vec3 const wo = at.frame.to_local(-p.ray.direction);
    bool const last = p.scatterings > bounces; // mirrors and glass do not count as scatterings
    bool const in_turn = vertex == 0 && interleaving.n > 1 && bounces > 0;
    bool const narrow = in_turn && has_narrow_lobe(at.bsdf), alone = in_turn && !narrow;
    if (!last && !world.light_select.empty() && !only_delta(at.bsdf)) aim_at_light(p, at, wo, alone);

    float const u_lobe = p.rng.uniform();
    if (in_turn && !(narrow && takes_narrow_lobe(at.bsdf, wo, u_lobe))) {
        p.sample.turn = p.share > 0 ? IndirectTurn::taken : IndirectTurn::waits;
        if (p.share == 0) return false;
        p.throughput *= float(p.share);
        p.emitted = alone;
    }
    BsdfSample const next = gi::sample(at.bsdf, wo, at.front, u_lobe, p.rng.uniform2());
    if (last && !next.delta) return false;
    p.throughput *= next.weight;
    float const survival = max_component(p.throughput);
    if (!(survival > 0)) return false;
    if (p.scatterings >= 3 && survival < 0.95f) {
        if (p.rng.uniform() >= survival) return false;
        p.throughput /= survival;
    }
    vec3 const direction = at.frame.to_world(next.wi);
    // With a shading normal, a direction may pass through an opaque surface; such light is discarded.
    if ((glm::dot(direction, at.geometric_normal) > 0) != (next.wi.z > 0)) return false;
    p.ray = {leave(at, direction), direction};
    p.arrival_pdf = next.delta ? 0 : next.pdf;
    if (!next.delta) ++p.scatterings;
    return true;
}

template <class Visibility>
void PathTracer<Visibility>::trace(std::span<Path> paths, PathCounts& counts) const
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
        visibility.nearest(std::span(queries).first(n), std::span(hits).first(n));
        choose_lights(std::span(active).first(n), std::span<Hit const>(hits).first(n));
        constexpr std::size_t kAhead = 4;
        for (std::size_t i = 0; i < n; ++i) {
            if (i + 2 * kAhead < n) fetch_surface(hits[i + 2 * kAhead]);
            if (i + kAhead < n) fetch_vertices(hits[i + kAhead]);
            active[i]->ended = !advance(*active[i], hits[i], vertex, counts);
        }
        add_unshadowed(std::span<Path* const>(active), visibility, counts);
        std::erase_if(active, [](Path const* p) { return p->ended; });
    }
    for (Path& p : paths)
        for (vec3& part : p.sample.radiance)
            if (!all_finite(part)) {
                part = vec3{0};
                ++counts.invalid_paths;
            }
}

/// In a separate loop, so that the cache misses of many choices overlap: the tables of a sky are large.
template <class Visibility>
void PathTracer<Visibility>::choose_lights(std::span<Path* const> paths, std::span<Hit const> hits) const
{
    if (world.light_select.empty()) return;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (hits[i].triangle == kNoTriangle) continue;
        LightChoice const choice = choose_light(world, paths[i]->rng.uniform_double());
        paths[i]->light = choice;
        if (!light_detail::is_environment(world, choice)) continue;
        vec3 const* const texel = &world.environment_radiance[choice.texel]; // the sample lies within half a texel
        std::size_t const row = world.environment_width;
        __builtin_prefetch(texel);
        if (choice.texel >= row) __builtin_prefetch(texel - row);
        if (choice.texel + row < world.environment_radiance.size()) __builtin_prefetch(texel + row);
    }
}

} // namespace gi
