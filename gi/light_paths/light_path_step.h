#pragma once
// One step of a light path: its start, and what happens at a surface. For CPU and CUDA.

#include "gi/core/rng.h"
#include "gi/light_paths/emission.h"
#include "gi/light_paths/light_vertex.h"
#include "gi/render/medium.h"
#include "gi/render/ray_query.h"
#include "gi/scene/shading/narrow_lobes.h"

namespace gi {

/// A light path between two surfaces.
struct LightPath {
    Pcg32 rng{0, 0};
    EmittedLight light;
    vec2 place{0};                        ///< random, of the light's start
    int scatterings = 0;                  ///< non-delta, so far
    std::uint32_t number = 0;             ///< see LightVertex::path
    std::uint32_t triangle = kNoTriangle; ///< that it leaves
    std::uint32_t medium = kNoMedium;     ///< see medium.h
    bool from_light = true, from_surface = false;
    bool from_outside = false, straight = true; ///< see LightPaths::grid_side
    bool by_delta = false;                      ///< since the last vertex
    bool by_panes_alone = true;                 ///< it has kept its direction from the start
    bool narrow = false;                        ///< it leaves its triangle by a narrow lobe (narrow_lobes.h)
    float paths = 1;                            ///< expected number of such paths that reach this vertex
    float area = 0, solid_angle = 0;            ///< over which one of them is spread where it left, m^2, sr
    float length = 0;                           ///< since then, m
};

/// A set of paths that are traced together, and share the power of the lights.
struct LightPathSet {
    std::uint32_t count; ///< >= 1
    std::uint64_t seed;
    std::uint32_t pass;
};

/// Starts path number i at a light. Returns the light.
GI_FN inline LightChoice start_at_light(WorldView const& world, Bounds const& bounds, LightPathSet const& set,
                                        std::uint32_t i, LightPath& p)
{
    p.number = i;
    p.rng = Pcg32::for_path(set.seed ^ 0x7619, i, set.pass);
    // Stratified over the lights, so that every light gets its share of the paths in each pass.
    double const u = (double(i) + p.rng.uniform_double()) / double(set.count);
    LightChoice const choice = choose_light(world, u);
    p.place = p.rng.uniform2();
    vec2 const direction = p.rng.uniform2();
    p.light = emit_light(world, choice, bounds, p.place, direction, p.rng.uniform());
    p.light.power /= float(set.count);
    p.paths = float(set.count) * world.light_select.probability(choice.light);
    p.area = p.light.area / p.paths;
    p.solid_angle = p.light.solid_angle / p.paths;
    return choice;
}

/// Chooses one of the delta lobes by how much each reflects or transmits.
GI_FN inline BsdfSample sample_delta_lobe(ShadingPoint const& at, vec3 arrived, float u)
{
    BsdfSample lobes[3];
    int const n = delta_lobes(at.bsdf, arrived, at.front, lobes);
    float sum = 0;
    for (int k = 0; k < n; ++k) sum += max_component(lobes[k].weight);
    float left = u * sum;
    for (int k = 0; k < n; ++k) {
        float const share = max_component(lobes[k].weight);
        if (left < share) {
            lobes[k].weight *= sum / share;
            return lobes[k];
        }
        left -= share;
    }
    return {};
}

/// When light paths end.
struct LightPathRules {
    int bounces;     ///< see LightPaths
    bool delta_only; ///< see LightPaths
};

/// Moves a path to a surface and samples its next direction.
/// @param keep  (position, triangle) -> false if the path ends there without a vertex
/// @param vertex, has_vertex  what it leaves there
/// Returns false if the path ends.
template <class Keep>
GI_FN bool advance(WorldView const& world, LightPathRules const& s, LightPath& p, Hit const& hit, Keep const& keep,
                   LightVertex& vertex, bool& has_vertex)
{
    has_vertex = false;
    if (hit.triangle == kNoTriangle) return false;
    vec3 const direction = p.light.ray.direction;
    ShadingPoint const at = shading_point(world, hit.triangle, hit.barycentric, direction);
    if (p.from_light && p.light.range > 0) {
        Light window;
        window.range = p.light.range;
        p.light.power *= light_detail::distance_attenuation(window, hit.distance) * square(hit.distance);
    }
    p.from_light = false;
    vec3 const arrived = at.frame.to_local(-direction);
    float const cos_arrived = glm::abs(glm::dot(direction, at.geometric_normal));
    if (!(arrived.z > 0) || !(cos_arrived > 0)) return false;
    vec3 const power = p.light.power * (arrived.z / cos_arrived) *
                       left_by_medium(world, p.medium, hit.triangle, at, hit.distance);
    if (!all_finite(power) || !(max_component(power) > 0)) return false;
    p.length += hit.distance;
    float const footprint = (p.area + p.solid_angle * square(p.length)) / cos_arrived;
    bool const starts = p.from_surface;
    p.from_surface = false;
    if (!only_delta(at.bsdf) && !(starts && s.delta_only)) {
        if (!keep(at.position, hit.triangle)) return false;
        has_vertex = true;
        vertex = {.position = at.position,
                  .normal = at.geometric_normal,
                  .triangle = hit.triangle,
                  .clearance = at.clearance,
                  .front = at.front,
                  .power = power,
                  .bsdf = at.bsdf,
                  .frame = at.frame,
                  .arrived = arrived,
                  .matt = bsdf_detail::is_matt(at.bsdf),
                  .by_delta = p.by_delta,
                  .by_panes_alone = p.by_panes_alone,
                  .scatterings = p.scatterings,
                  .footprint = footprint,
                  .path = p.number};
    }
    float const u_lobe = p.rng.uniform();
    BsdfSample const next = s.delta_only ? sample_delta_lobe(at, arrived, u_lobe)
                                         : sample(at.bsdf, arrived, at.front, u_lobe, p.rng.uniform2());
    p.straight = !next.delta;
    p.narrow = has_narrow_lobe(at.bsdf) && takes_narrow_lobe(at.bsdf, arrived, u_lobe);
    if (!next.delta && ++p.scatterings >= s.bounces) return false;
    vec3 const leaves = at.frame.to_world(next.wi);
    float const cos_leaves = glm::dot(leaves, at.geometric_normal);
    if ((cos_leaves > 0) != (next.wi.z > 0) || next.wi.z == 0) return false;
    // The sampled weight is that of a camera path: it contains the cosine with the shading normal on this side.
    vec3 weight = next.weight * std::abs(cos_leaves / next.wi.z);
    // Refraction scales radiance, but not power.
    if (next.transmitted && !at.bsdf.thin) weight *= square(at.front ? at.bsdf.ior : 1 / at.bsdf.ior);
    float const survival = glm::min(1.0f, max_component(weight));
    if (!(survival > 0) || p.rng.uniform() >= survival) return false;
    p.light.power = power * weight / survival;
    p.by_delta = next.delta;
    p.by_panes_alone = p.by_panes_alone && next.transmitted && at.bsdf.thin;
    p.paths *= survival;
    if (next.delta) {
        p.area /= survival;
        p.solid_angle /= survival;
    } else {
        p.area = footprint / survival;
        p.solid_angle = 1 / (next.pdf * p.paths);
        p.length = 0;
    }
    p.triangle = hit.triangle;
    p.medium = medium_beyond(world, p.medium, hit.triangle, at, next);
    p.light.ray = {leave(at, leaves), leaves};
    return true;
}

} // namespace gi
