#pragma once
// One step of a path at a surface, the same for every path tracer, on CPU and GPU: the light that reaches it
// there, what a light sample adds, and whether the path continues. Next-event estimation and sampling of
// directions are combined with the power heuristic (Veach 1997, sec. 9.2.4).

#include "gi/render/medium.h"
#include "gi/render/path_sample.h"
#include "gi/render/sampling.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/shading/light_sampling.h"
#include "gi/scene/shading/shading_point.h"

namespace gi {

/// What a path carries from surface to surface.
struct PathState {
    vec3 throughput{1};
    /// Probability density of the arrival direction, 1/sr; 0 = camera or delta lobe,
    /// which no other technique samples.
    float arrival_pdf = 0;
    int scatterings = 0; ///< non-delta, so far
    std::uint32_t medium = kNoMedium; ///< see medium.h
};

/// The sum for light that scatters so often (non-delta) between its source and the camera: L0, L1 or L2.
GI_FN inline vec3& layer_of(PathSample& sample, int scatterings)
{
    return scatterings == 0 ? sample.radiance[0] : scatterings == 1 ? sample.radiance[1] : sample.radiance[2];
}

/// Adds to that sum. Without its address, for which kernels would keep all sums in local memory.
GI_FN inline void add_light(PathSample& sample, int scatterings, vec3 light)
{
    int const layer = scatterings < 2 ? scatterings : 2;
#pragma unroll
    for (int k = 0; k < 3; ++k)
        if (k == layer) sample.radiance[std::size_t(k)] += light;
}

/// Stores what the camera sees at a path's first surface.
GI_FN inline void see_first_surface(PathSample& sample, ShadingPoint const& at, CameraRays const& camera)
{
    sample.hit = true;
    sample.albedo = albedo(at.bsdf);
    sample.normal = at.frame.normal;
    sample.position = at.position;
    sample.depth = glm::dot(at.position - camera.origin, camera.forward);
}

/// Radiance of the environment along a path's ray, weighted against light sampling.
GI_FN inline vec3 met_environment(WorldView const& world, PathState const& s, vec3 direction)
{
    vec3 light = environment_radiance(world, direction);
    if (s.arrival_pdf > 0) light *= power_heuristic(s.arrival_pdf, environment_direction_pdf(world, direction));
    return light;
}

/// Emission of a surface that a path hits, weighted against light sampling. @param distance  of the ray, m
GI_FN inline vec3 met_emission(WorldView const& world, PathState const& s, ShadingPoint const& at,
                               std::uint32_t triangle, vec3 direction, float distance)
{
    vec3 light = at.emission;
    if (s.arrival_pdf > 0) {
        float const cos_light = std::abs(glm::dot(direction, at.geometric_normal));
        light *= power_heuristic(s.arrival_pdf, emitter_direction_pdf(world, triangle, distance, cos_light));
    }
    return light;
}

/// False if a direction passes through an opaque surface, as can happen with a shading normal; such light is
/// discarded. @param local  the direction in at.frame
GI_FN inline bool is_on_one_side(ShadingPoint const& at, vec3 direction, vec3 local)
{
    return (glm::dot(direction, at.geometric_normal) > 0) == (local.z > 0);
}

/// Radiance of a light sample after scattering towards wo by all non-delta lobes, if nothing is between. Weighted
/// against sampling of directions unless `alone`: no path continues that could hit the light.
/// @param pdf    (BsdfValue, wi) -> density with which paths leave along wi, 1/sr
/// @param share  factor for all of it
template <class Pdf>
GI_FN vec3 unshadowed_light(ShadingPoint const& at, vec3 wo, LightSample const& light, bool alone, Pdf const& pdf,
                            float share = 1)
{
    if (!(light.pdf > 0)) return vec3{0};
    vec3 const wi = at.frame.to_local(light.direction);
    if (!is_on_one_side(at, light.direction, wi)) return vec3{0};
    BsdfValue const bsdf = evaluate(at.bsdf, wo, wi);
    vec3 value = bsdf.f * light.radiance * (share * std::abs(wi.z) / light.pdf);
    if (!(max_component(value) > 0)) return vec3{0};
    if (!light.delta && !alone) value *= power_heuristic(light.pdf, pdf(bsdf, wi));
    return value;
}

/// Russian roulette: false if the path ends, otherwise its throughput is divided by the probability of continuing.
/// @param roulette  see SlhbSettings; 0: all paths continue up to the fourth scattering,
///   then with a probability of their throughput
/// @param uniform   () -> a number in [0, 1); called only if needed
template <class Uniform>
GI_FN bool survives_roulette(PathState& s, float roulette, Uniform const& uniform)
{
    float const largest = max_component(s.throughput);
    if (!(largest > 0)) return false;
    float const keep = roulette > 0                            ? glm::min(1.0f, roulette * largest)
                       : s.scatterings >= 3 && largest < 0.95f ? largest
                                                               : 1.0f;
    if (keep < 1) {
        if (uniform() >= keep) return false;
        s.throughput /= keep;
    }
    return true;
}

/// Sets parts that are not finite to zero. Returns their number.
GI_FN inline std::uint32_t discard_invalid(PathSample& sample)
{
    std::uint32_t n = 0;
#pragma unroll
    for (std::size_t k = 0; k < 3; ++k)
        if (!all_finite(sample.radiance[k])) {
            sample.radiance[k] = vec3{0};
            ++n;
        }
    return n;
}

} // namespace gi
