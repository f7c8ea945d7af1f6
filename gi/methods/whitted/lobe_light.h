#pragma once
// Light at the points of ray trees, lobe by lobe, from what is known of the light that arrives.

#include "gi/methods/whitted/tree_tracer.h"

namespace gi {

/// Radiance that a surface sends towards wo by what leaves in all directions alike, per irradiance, 1/sr.
inline vec3 diffuse_response(TreePoint const& p) { return kInvPi * diffuse_albedo(p.at.bsdf, p.wo.z); }

/// Radiance that the glossy lobe of a surface sends towards wo; none if a ray brings it.
/// @param directions  samples of the lobe  @param radiance  (unit direction) -> radiance that comes from there
template <class Radiance>
vec3 glossy_radiance(TreePoint& p, int directions, Radiance const& radiance)
{
    Bsdf const& b = p.at.bsdf;
    bool const glossy = b.model == MaterialModel::phong ? max_component(b.phong_specular) > 0
                                                        : b.f90.x > 0 && !bsdf_detail::specular_is_delta(b);
    if (!glossy || p.glossy_traced) return vec3{0};
    Bsdf const lobe = glossy_lobe(b);
    vec3 sum{0};
    vec2 const shift = p.rng.uniform2();
    for (int k = 0; k < directions; ++k) {
        vec2 const u = glm::fract(shift + float(k) * vec2{1 / float(directions), 0.61803399f}); // a lattice
        vec3 const wi = bsdf_detail::sample_specular(b, p.wo, u);
        if (!(wi.z > 0)) continue;
        BsdfValue const value = evaluate(lobe, p.wo, wi);
        if (value.pdf > 0) sum += value.f * (wi.z / value.pdf) * radiance(p.at.frame.to_world(wi));
    }
    return sum / float(directions);
}

} // namespace gi
