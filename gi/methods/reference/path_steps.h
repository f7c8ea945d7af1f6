#pragma once
// The steps of the path tracer, on CPU and GPU: next-event estimation and BSDF sampling (gi/render/path_step.h),
// Russian roulette on throughput. The estimator is unbiased except for the limit on bounces and the disks of
// photons (lamp_caustics.h); nothing is clamped.
//
// Light is sorted by the number of non-delta scatterings between the light and the eye: L0 emitted light seen
// directly (also through mirrors and glass), L1 direct light, L2 all indirect light.

#include "gi/render/interleaving.h"
#include "gi/render/ray_path.h"
#include "gi/scene/shading/narrow_lobes.h"

#include <utility>

namespace gi {

/// State of one path.
struct Path : RayPath {
    LightChoice light;       ///< chosen for the next surface
    bool emitted = false;    ///< emission of the next surface or sky has already been counted
    std::uint32_t share = 1; ///< number of pixels for which it computes indirect light, see Interleaving
    FirstHit first;          ///< what the camera sees
};

/// Adds nothing to the light at a surface.
struct NoMoreLight {
    GI_FN void operator()(Path&, ShadingPoint const&, vec3) const {}
};

/// What the paths of a picture have in common.
struct PathSteps {
    WorldView world; ///< in the memory space of those who trace
    CameraRays camera;
    int bounces;
    std::uint64_t seed;
    PixelFilter filter;
    int width;
    Interleaving interleaving{};

    /// Starts path number `index` of pixel (x, y) at the camera.
    GI_FN Path start(int x, int y, std::uint32_t index) const;
    GI_FN void choose_light(Path& p) const { p.light = gi::choose_light(world, p.rng.uniform_double()); }
    /// Advances from a hit to the next ray. Returns false if the path ends.
    /// @param more  (path, surface, wo): adds light that no sample of the lights finds
    template <class More = NoMoreLight>
    GI_FN bool advance(Path& p, Hit const& hit, int vertex, PathCounts& counts, More const& more = {}) const;
};

GI_FN inline Path PathSteps::start(int x, int y, std::uint32_t index) const
{
    Path p;
    start_path(p, camera, filter, seed, {x, y}, width, index);
    std::uint32_t const pixel = std::uint32_t(y) * std::uint32_t(width) + std::uint32_t(x);
    if (interleaving.n > 1) p.share = interleaving.share(pixel, std::uint32_t(width), index);
    return p;
}

template <class More>
GI_FN bool PathSteps::advance(Path& p, Hit const& hit, int vertex, PathCounts& counts, More const& more) const
{
    if (hit.triangle == kNoTriangle) {
        if (!p.emitted) add_environment(world, p, vertex);
        return false;
    }
    vec3 const arrival = p.ray.direction;
    ShadingPoint const at = shading_point(world, hit.triangle, hit.barycentric, arrival);
    p.throughput *= left_by_medium(world, p.medium, hit.triangle, at, hit.distance);
    if (vertex == 0) {
        p.first = {hit.triangle, hit.barycentric};
        see_first_surface(p.sample, at, camera);
    }
    if (!std::exchange(p.emitted, false) && max_component(at.emission) > 0)
        add_light(p.sample, p.scatterings,
                  p.throughput * met_emission(world, p, at, hit.triangle, arrival, hit.distance));
    if (vertex == kLongestPath) {
        ++counts.cut_paths;
        return false;
    }

    vec3 const wo = at.frame.to_local(-arrival);
    bool const last = p.scatterings > bounces; // mirrors and glass do not count as scatterings
    bool const in_turn = vertex == 0 && interleaving.n > 1 && bounces > 0;
    bool const narrow = in_turn && has_narrow_lobe(at.bsdf), alone = in_turn && !narrow;
    if (!last && !world.light_select.empty() && !only_delta(at.bsdf)) {
        LightSample const light = sample_light(world, p.light, at.position, p.rng.uniform2());
        auto const pdf = [](BsdfValue const& bsdf, vec3) { return bsdf.pdf; };
        aim_at_light(p, at, light, unshadowed_light(at, wo, light, alone, pdf));
        more(p, at, wo);
    }

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
    p.medium = medium_beyond(world, p.medium, hit.triangle, at, next);
    return continue_path(p, at, next);
}

} // namespace gi
