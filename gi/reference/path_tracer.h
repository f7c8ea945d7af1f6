#pragma once
// Path tracing: next-event estimation and BSDF sampling combined with the power heuristic (Veach 1997,
// sec. 9.2.4), Russian roulette on throughput. The estimator is unbiased but for the limit on bounces; nothing is
// clamped.
//
// Paths advance together, one surface at a time: all nearest hits, then all scatterings, then all shadow rays.
// Each path draws from its own random stream, so how they are grouped does not change them; but work on one path
// hides the cache misses of another.
//
// Light is sorted by the number of non-delta scatterings between the lamp and the eye: L0 emitted light seen
// directly (also through mirrors and glass), L1 direct light, L2 all indirect light.

#include "gi/base/rng.h"
#include "gi/image/render_settings.h"
#include "gi/reference/exact_visibility.h"
#include "gi/scene/camera.h"
#include "gi/scene/light_sampling.h"
#include "gi/scene/shading_point.h"

#include <array>
#include <span>
#include <vector>

namespace gi {

/// Longest chain of surfaces a path may visit, delta lobes included. Reaching it is counted.
inline constexpr int kLongestPath = 1024;

struct PathSample {
    std::array<vec3, 3> radiance{vec3{0}, vec3{0}, vec3{0}}; ///< L0, L1, L2
    vec3 albedo{0}, normal{0}, position{0};                  ///< at the first surface
    float depth = 0;                                         ///< m along the camera's axis
    bool hit = false;
};

struct PathCounts {
    std::uint64_t nearest_rays = 0, shadow_rays = 0, cut_paths = 0, invalid_paths = 0;
};

/// One path on its way.
struct Path {
    Pcg32 rng{0, 0};
    Ray ray;
    vec3 throughput{1};
    float arrival_pdf =
        0;               ///< density of the direction we come along; 0 = camera or delta lobe: no other technique
    int scatterings = 0; ///< non-delta, so far
    Hit hit;
    bool ended = false;
    Ray shadow_ray;
    float shadow_reach = 0; ///< m
    int shadow_bucket = 0;
    vec3 shadow_radiance{0}; ///< what arrives if nothing is between; 0 = no shadow ray wanted
    PathSample sample;

    vec3& bucket(int scattered) { return sample.radiance[std::size_t(std::min(scattered, 2))]; }
};

/// Veach's power heuristic with exponent 2.
inline float power_heuristic(float pdf, float other)
{
    float const ratio = other / pdf; // squares of the densities themselves would overflow near small lamps
    return 1.0f / (1.0f + ratio * ratio);
}

/// Filter importance sampling: where in the plane the path of a pixel starts, relative to the pixel's centre (px).
inline vec2 filter_offset(PixelFilter filter, vec2 u)
{
    if (filter == PixelFilter::box) return u - 0.5f;
    auto const tent = [](float v) {
        return v < 0.5f ? std::sqrt(2 * v) - 1 : 1 - std::sqrt(std::max(0.0f, 2 - 2 * v));
    };
    return {tent(u.x), tent(u.y)};
}

/// @tparam Visibility answers nearest(origin, direction, seed) and occluded(origin, direction, distance, seed)
template <class Visibility>
struct PathTracer {
    WorldView world;
    Visibility const& visibility;
    CameraRays camera;
    int bounces;
    std::uint64_t seed;
    PixelFilter filter;
    int width;

    /// Path number `index` of pixel (x, y), at the camera.
    Path start(int x, int y, std::uint32_t index) const
    {
        Path p;
        p.rng = Pcg32::for_path(seed, std::uint32_t(y) * std::uint32_t(width) + std::uint32_t(x), index);
        p.ray = camera.through(vec2{float(x) + 0.5f, float(y) + 0.5f} + filter_offset(filter, p.rng.uniform2()));
        return p;
    }
    /// Follow all paths to their ends.
    void trace(std::span<Path> paths, PathCounts& counts) const;

private:
    /// More than the rounding error of the interpolated position, which scales with the coordinates of the
    /// triangle it was interpolated from.
    float clearance(ShadingPoint const& at) const
    {
        uvec3 const t = world.triangles[at.triangle];
        vec3 const extent = glm::max(glm::abs(world.positions[t.x]),
                                     glm::max(glm::abs(world.positions[t.y]), glm::abs(world.positions[t.z])));
        return 2e-6f * max_component(extent);
    }
    vec3 leave(ShadingPoint const& at, vec3 direction) const
    {
        float const offset = clearance(at);
        return at.position +
               (glm::dot(direction, at.geometric_normal) > 0 ? offset : -offset) * at.geometric_normal;
    }
    void collect_environment(Path& p) const;
    void collect_emission(Path& p, ShadingPoint const& at) const;
    void aim_at_light(Path& p, ShadingPoint const& at, vec3 wo) const;
    bool advance(Path& p, int vertex, PathCounts& counts) const;
};

template <class Visibility>
void PathTracer<Visibility>::collect_environment(Path& p) const
{
    if (world.environment_radiance.empty()) return;
    vec3 light = environment_radiance(world, p.ray.direction);
    if (p.arrival_pdf > 0)
        light *= power_heuristic(p.arrival_pdf, environment_direction_pdf(world, p.ray.direction));
    p.bucket(p.scatterings) += p.throughput * light;
}

template <class Visibility>
void PathTracer<Visibility>::collect_emission(Path& p, ShadingPoint const& at) const
{
    vec3 light = at.emission;
    if (p.arrival_pdf > 0) {
        float const cos_light = std::abs(glm::dot(p.ray.direction, at.geometric_normal));
        light *= power_heuristic(p.arrival_pdf,
                                 emitter_direction_pdf(world, p.hit.triangle, p.hit.distance, cos_light));
    }
    p.bucket(p.scatterings) += p.throughput * light;
}

template <class Visibility>
void PathTracer<Visibility>::aim_at_light(Path& p, ShadingPoint const& at, vec3 wo) const
{
    double const u_select = p.rng.uniform_double();
    LightSample const light = sample_light(world, at.position, u_select, p.rng.uniform2());
    if (!(light.pdf > 0)) return;
    vec3 const wi = at.frame.to_local(light.direction);
    if ((wi.z > 0) != (glm::dot(light.direction, at.geometric_normal) > 0)) return;
    vec3 value = evaluate(at.bsdf, wo, wi) * light.radiance * (std::abs(wi.z) / light.pdf);
    if (!(max_component(value) > 0)) return;
    if (!light.delta) value *= power_heuristic(light.pdf, pdf(at.bsdf, wo, wi));

    p.shadow_radiance = p.throughput * value;
    p.shadow_bucket = p.scatterings + 1;
    p.shadow_ray = {leave(at, light.direction), light.direction};
    p.shadow_reach = light.distance;
    if (light.distance == kInf) return;
    // Aim from where the ray starts, and stop short of the lamp's own surface by more than the rounding of both
    // ends.
    vec3 const way = at.position + light.distance * light.direction - p.shadow_ray.origin;
    float const length = glm::length(way);
    p.shadow_ray.direction = way / length;
    p.shadow_reach = length * (1 - 2e-5f) - clearance(at);
}

/// From a hit to the next ray. False where the path ends.
template <class Visibility>
bool PathTracer<Visibility>::advance(Path& p, int vertex, PathCounts& counts) const
{
    p.shadow_radiance = vec3{0};
    if (p.hit.triangle == kNoTriangle) {
        collect_environment(p);
        return false;
    }
    ShadingPoint const at = shading_point(world, p.hit.triangle, p.hit.barycentric, p.ray.direction);
    if (vertex == 0) {
        p.sample.hit = true;
        p.sample.albedo = at.albedo;
        p.sample.normal = at.frame.normal;
        p.sample.position = at.position;
        p.sample.depth = glm::dot(at.position - camera.origin, camera.forward);
    }
    if (max_component(at.emission) > 0) collect_emission(p, at);
    if (p.scatterings > bounces) return false;
    if (vertex == kLongestPath) {
        ++counts.cut_paths;
        return false;
    }

    vec3 const wo = at.frame.to_local(-p.ray.direction);
    if (!world.light_select.empty() && !only_delta(at.bsdf)) aim_at_light(p, at, wo);

    float const u_lobe = p.rng.uniform();
    BsdfSample const next = gi::sample(at.bsdf, wo, at.front, u_lobe, p.rng.uniform2());
    p.throughput *= next.weight;
    float const survival = max_component(p.throughput);
    if (!(survival > 0)) return false;
    if (p.scatterings >= 3 && survival < 0.95f) {
        if (p.rng.uniform() >= survival) return false;
        p.throughput /= survival;
    }
    vec3 const direction = at.frame.to_world(next.wi);
    // A shading normal may send light through an opaque surface; that part does not exist.
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
    for (Path& p : paths) active.push_back(&p);
    for (int vertex = 0; !active.empty(); ++vertex) {
        counts.nearest_rays += active.size();
        for (Path* p : active) {
            p->hit = visibility.nearest(p->ray.origin, p->ray.direction, p->rng.next());
            if (p->hit.triangle == kNoTriangle) continue;
            __builtin_prefetch(&world.triangles[p->hit.triangle]);
            __builtin_prefetch(&world.triangle_material[p->hit.triangle]);
        }
        for (Path* p : active) {
            if (p->hit.triangle == kNoTriangle) continue;
            uvec3 const t = world.triangles[p->hit.triangle];
            for (int k = 0; k < 3; ++k) {
                __builtin_prefetch(&world.positions[t[k]]);
                if (!world.normals.empty()) __builtin_prefetch(&world.normals[t[k]]);
            }
        }
        for (Path* p : active) p->ended = !advance(*p, vertex, counts);
        for (Path* p : active) {
            if (!(max_component(p->shadow_radiance) > 0)) continue;
            ++counts.shadow_rays;
            bool const blocked =
                p->shadow_reach > 0 &&
                visibility.occluded(p->shadow_ray.origin, p->shadow_ray.direction, p->shadow_reach, p->rng.next());
            if (!blocked) p->bucket(p->shadow_bucket) += p->shadow_radiance;
        }
        std::erase_if(active, [](Path const* p) { return p->ended; });
    }
    for (Path& p : paths)
        for (vec3& part : p.sample.radiance)
            if (!all_finite(part)) {
                part = vec3{0};
                ++counts.invalid_paths;
            }
}

} // namespace gi
