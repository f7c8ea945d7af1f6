#pragma once
// Isotropic GGX microfacets (Walter et al. 2007) with height-correlated Smith masking (Heitz 2014). Local frame,
// +z up; directions are unit and above the surface.

#include "gi/scene/shading/warp.h"

namespace gi {

/// Density of microfacet normals, 1/sr.
GI_FN inline float ggx_normals(vec3 h, float alpha)
{
    // Computed from h.x and h.y, because 1 - h.z^2 loses all precision for narrow lobes.
    float const a2 = alpha * alpha;
    float const t = (h.x * h.x + h.y * h.y) / a2 + h.z * h.z;
    return 1.0f / (kPi * a2 * t * t);
}

GI_FN inline float ggx_root(float cos_theta, float alpha)
{
    float const a2 = alpha * alpha;
    return std::sqrt(a2 + (1 - a2) * cos_theta * cos_theta);
}

/// G2 / (4 cos_o cos_i).
GI_FN inline float ggx_visibility(float cos_o, float cos_i, float alpha)
{
    return 0.5f / (cos_i * ggx_root(cos_o, alpha) + cos_o * ggx_root(cos_i, alpha));
}

/// Density of wi = reflect(wo, h) for h drawn by sample_ggx_normal. @param normals ggx_normals(h, alpha)
GI_FN inline float ggx_reflection_pdf(vec3 wo, float normals, float alpha)
{
    return 0.5f * normals / (wo.z + ggx_root(wo.z, alpha));
}

/// Samples a normal visible from wo (Dupuy & Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps").
GI_FN inline vec3 sample_ggx_normal(vec3 wo, float alpha, vec2 u)
{
    vec3 const stretched = glm::normalize(vec3{alpha * wo.x, alpha * wo.y, wo.z});
    float const z = (1 - u.x) * (1 + stretched.z) - stretched.z;
    vec3 const cap{std::sqrt(glm::clamp(1 - z * z, 0.0f, 1.0f)) * azimuth(u.y), z};
    vec3 const h = cap + stretched;
    return glm::normalize(vec3{alpha * h.x, alpha * h.y, glm::max(h.z, 1e-30f)});
}

} // namespace gi
