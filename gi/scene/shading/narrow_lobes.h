#pragma once
// Lobes too narrow for a discrete set of axes, and how a surface combines them with other lobes.

#include "gi/scene/shading/bsdf.h"

namespace gi {

/// Lobes narrower than this GGX alpha are sampled with exact rays.
inline constexpr float kNarrowAlpha = 0.2f;
/// Same for Phong exponents above this.
inline constexpr float kNarrowExponent = 40;

/// True if some lobe is narrow, smooth or clear.
GI_FN inline bool has_narrow_lobe(Bsdf const& b)
{
    if (b.model == MaterialModel::phong)
        return max_component(b.phong_specular) > 0 && b.phong_exponent > kNarrowExponent;
    return b.clear > 0 || (b.f90.x > 0 && b.alpha < kNarrowAlpha);
}

/// True if gi::sample chooses a lobe other than the diffuse one.
GI_FN inline bool takes_narrow_lobe(Bsdf const& b, vec3 wo, float u_lobe)
{
    bsdf_detail::LobeChances const chance = bsdf_detail::lobe_chances(b, wo.z);
    return u_lobe < chance.clear + chance.specular;
}

} // namespace gi
