#pragma once
// One light path at a time, written to be read: next-event estimation and BSDF sampling combined with the power
// heuristic (Veach 1997, sec. 9.2.4), Russian roulette on throughput. The estimator is unbiased but for the limit
// on bounces; nothing is clamped.
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

    PathSample trace(int x, int y, std::uint32_t path, PathCounts& counts) const;

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
    bool reaches(ShadingPoint const& at, LightSample const& light, std::uint32_t alpha_seed) const;
    vec3 direct_light(ShadingPoint const& at, vec3 wo, Pcg32& rng, PathCounts& counts) const;
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

template <class Visibility>
bool PathTracer<Visibility>::reaches(ShadingPoint const& at, LightSample const& light,
                                     std::uint32_t alpha_seed) const
{
    vec3 const origin = leave(at, light.direction);
    if (light.distance == kInf) return !visibility.occluded(origin, light.direction, kInf, alpha_seed);
    // Aim from where the ray starts, and stop short of the lamp's own surface by more than the rounding of both
    // ends.
    vec3 const way = at.position + light.distance * light.direction - origin;
    float const length = glm::length(way);
    float const reach = length * (1 - 2e-5f) - clearance(at);
    return !(reach > 0) || !visibility.occluded(origin, way / length, reach, alpha_seed);
}

template <class Visibility>
vec3 PathTracer<Visibility>::direct_light(ShadingPoint const& at, vec3 wo, Pcg32& rng, PathCounts& counts) const
{
    double const u_select = rng.uniform_double();
    LightSample const light = sample_light(world, at.position, u_select, rng.uniform2());
    if (!(light.pdf > 0)) return vec3{0};
    vec3 const wi = at.frame.to_local(light.direction);
    bool const same_side = wi.z > 0;
    if (same_side != (glm::dot(light.direction, at.geometric_normal) > 0)) return vec3{0};
    vec3 const f = evaluate(at.bsdf, wo, wi);
    vec3 value = f * light.radiance * (std::abs(wi.z) / light.pdf);
    if (!(max_component(value) > 0)) return vec3{0};
    if (!light.delta) value *= power_heuristic(light.pdf, pdf(at.bsdf, wo, wi));
    ++counts.shadow_rays;
    return reaches(at, light, rng.next()) ? value : vec3{0};
}

template <class Visibility>
PathSample PathTracer<Visibility>::trace(int x, int y, std::uint32_t path, PathCounts& counts) const
{
    auto rng = Pcg32::for_path(seed, std::uint32_t(y) * std::uint32_t(width) + std::uint32_t(x), path);
    PathSample sample;
    Ray ray = camera.through(vec2{float(x) + 0.5f, float(y) + 0.5f} + filter_offset(filter, rng.uniform2()));
    vec3 throughput{1};
    float arrival_pdf = 0; // density of the direction we come along; 0 = camera or delta lobe: no other technique
    int scatterings = 0;
    bool const any_light = !world.light_select.empty();

    for (int vertex = 0;; ++vertex) {
        ++counts.nearest_rays;
        Hit const hit = visibility.nearest(ray.origin, ray.direction, rng.next());
        vec3& bucket = sample.radiance[std::size_t(std::min(scatterings, 2))];
        if (hit.triangle == kNoTriangle) {
            if (!world.environment_radiance.empty()) {
                vec3 light = environment_radiance(world, ray.direction);
                if (arrival_pdf > 0)
                    light *= power_heuristic(arrival_pdf, environment_direction_pdf(world, ray.direction));
                bucket += throughput * light;
            }
            break;
        }

        ShadingPoint const at = shading_point(world, hit.triangle, hit.barycentric, ray.direction);
        if (vertex == 0) {
            sample.hit = true;
            sample.albedo = at.albedo;
            sample.normal = at.frame.normal;
            sample.position = at.position;
            sample.depth = glm::dot(at.position - camera.origin, camera.forward);
        }
        if (max_component(at.emission) > 0) {
            vec3 light = at.emission;
            if (arrival_pdf > 0) {
                float const cos_light = std::abs(glm::dot(ray.direction, at.geometric_normal));
                light *= power_heuristic(arrival_pdf,
                                         emitter_direction_pdf(world, hit.triangle, hit.distance, cos_light));
            }
            bucket += throughput * light;
        }
        if (scatterings > bounces) break;
        if (vertex == kLongestPath) {
            ++counts.cut_paths;
            break;
        }

        vec3 const wo = at.frame.to_local(-ray.direction);
        if (any_light && !only_delta(at.bsdf))
            sample.radiance[scatterings == 0 ? 1 : 2] += throughput * direct_light(at, wo, rng, counts);

        float const u_lobe = rng.uniform();
        BsdfSample const next = gi::sample(at.bsdf, wo, at.front, u_lobe, rng.uniform2());
        throughput *= next.weight;
        float survival = max_component(throughput);
        if (!(survival > 0)) break;
        if (scatterings >= 3 && survival < 0.95f) {
            if (rng.uniform() >= survival) break;
            throughput /= survival;
        }
        vec3 const direction = at.frame.to_world(next.wi);
        // A shading normal may send light through an opaque surface; that part does not exist.
        if ((glm::dot(direction, at.geometric_normal) > 0) != (next.wi.z > 0)) break;
        ray = {leave(at, direction), direction};
        arrival_pdf = next.delta ? 0 : next.pdf;
        if (!next.delta) ++scatterings;
    }

    for (vec3& part : sample.radiance)
        if (!all_finite(part)) {
            part = vec3{0};
            ++counts.invalid_paths;
        }
    return sample;
}

} // namespace gi
