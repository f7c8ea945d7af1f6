#pragma once
// A path whose segments are exact rays, on CPU and GPU: its start, and its parts at a surface. path_batch.h traces
// many of them on the CPU.

#include "gi/core/rng.h"
#include "gi/render/path_step.h"
#include "gi/render/ray_query.h"
#include "gi/scene/shading/warp.h"

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
    int shadow_scatterings = 0; ///< with which its light is added, see add_light
    vec3 shadow_radiance{0};    ///< radiance that arrives if unblocked; 0 = no shadow ray needed
    PathSample sample;
};

/// Separate, so that it does not affect the rounding of pinhole rays; by value, as a reference would make kernels
/// copy all their parameters to local memory.
[[gnu::noinline]] GI_FN inline Ray lens_ray(CameraRays camera, vec2 place, vec2 u)
{
    return camera.at_lens(square_to_disk(u)).through(place);
}

/// Ray through a point of the image plane (px) and a random point of the lens. @param u  () -> uniform in [0, 1)^2
template <class Uniform2>
GI_FN Ray camera_ray(CameraRays const& camera, vec2 place, Uniform2 const& u)
{
    return camera.has_lens() ? lens_ray(camera, place, u()) : camera.through(place);
}

/// Starts path number `index` of pixel (x, y) at the camera.
GI_FN inline void start_path(RayPath& p, CameraRays const& camera, PixelFilter filter, std::uint64_t seed,
                             glm::ivec2 at, int width, std::uint32_t index)
{
    p.rng = Pcg32::for_path(seed, std::uint32_t(at.y) * std::uint32_t(width) + std::uint32_t(at.x), index);
    vec2 const place = vec2{float(at.x) + 0.5f, float(at.y) + 0.5f} + filter_offset(filter, p.rng.uniform2());
    p.ray = camera_ray(camera, place, [&] { return p.rng.uniform2(); });
}

/// Adds the light of the environment to a path that hits nothing. @param vertex  number of surfaces before
GI_FN inline void add_environment(WorldView const& world, RayPath& p, int vertex)
{
    if (vertex == 0)
        p.sample.radiance[0] = background_radiance(world, p.ray.direction);
    else if (!world.environment_radiance.empty())
        add_light(p.sample, p.scatterings, p.throughput * met_environment(world, p, p.ray.direction));
}

/// Shadow ray from a surface to just before a light; reach <= 0 if the light lies on the surface.
GI_FN inline RayQuery shadow_ray(vec3 position, vec3 normal, float clearance, LightSample const& light)
{
    float const side = glm::dot(light.direction, normal) > 0 ? clearance : -clearance;
    RayQuery q{.ray = {position + side * normal, light.direction},
               .reach = light.distance,
               .to_lamp = light.delta ? 1u : 0u};
    if (light.distance == kInf) return q;
    // Aims from the ray's start, and ends before the light's own surface by more than the rounding of both ends.
    vec3 const way = position + light.distance * light.direction - q.ray.origin;
    float const length = glm::length(way);
    q.ray.direction = way * (1 / length);
    q.reach = length * (1 - 2e-5f) - clearance;
    return q;
}

/// Notes a light sample's radiance for the path's shadow ray.
GI_FN inline void aim_at_light(RayPath& p, ShadingPoint const& at, LightSample const& light, vec3 unshadowed)
{
    if (!(max_component(unshadowed) > 0)) return;
    p.shadow_radiance = p.throughput * unshadowed;
    p.shadow_scatterings = p.scatterings + 1;
    p.shadow = shadow_ray(at.position, at.geometric_normal, at.clearance, light);
}

GI_FN inline void add_noted_light(RayPath& p) { add_light(p.sample, p.shadow_scatterings, p.shadow_radiance); }

/// True if a shadow ray decides about the noted light sample; one that lies on the surface itself is added.
GI_FN inline bool needs_shadow_ray(RayPath& p)
{
    if (!(max_component(p.shadow_radiance) > 0)) return false;
    if (!(p.shadow.reach > 0)) {
        add_noted_light(p);
        return false;
    }
    p.shadow.seed = p.rng.next();
    return true;
}

/// The ray to the next surface. @param vertex  number of surfaces before
GI_FN inline RayQuery next_query(RayPath& p, int vertex)
{
    return {.ray = p.ray, .seed = p.rng.next(), .start = vertex == 0 ? camera_clearance(p.ray.origin) : 0};
}

/// Continues a path along a sampled direction. Returns false if it ends.
GI_FN inline bool continue_path(RayPath& p, ShadingPoint const& at, BsdfSample const& next)
{
    if (!survives_roulette(p, 0, [&] { return p.rng.uniform(); })) return false;
    vec3 const direction = at.frame.to_world(next.wi);
    if (!is_on_one_side(at, direction, next.wi)) return false;
    p.ray = {leave(at, direction), direction};
    p.arrival_pdf = next.delta ? 0 : next.pdf;
    if (!next.delta) ++p.scatterings;
    return true;
}

} // namespace gi
