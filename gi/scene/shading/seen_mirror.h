#pragma once
// Surfaces that show other surfaces: mirrors and panes, whose strongest delta lobe leaves more of the light than half
// of their albedo. Pictures are described by what is seen in these (gi/surfaces).

#include "gi/scene/shading/shading_point.h"

namespace gi {

/// Mirrors and panes that are followed, one behind the other.
inline constexpr int kMostMirrors = 6;

/// False if a material has no delta lobe.
GI_FN inline bool may_mirror(Bsdf const& b)
{
    return b.clear > 0 || (!bsdf_detail::is_matt(b) && b.f90.x > 0 && bsdf_detail::specular_is_delta(b));
}

/// Finds the lobe that a mirror or pane shows. @param wo  local  @return false: the surface itself is seen
GI_FN inline bool find_mirror(ShadingPoint const& at, vec3 wo, BsdfSample& lobe)
{
    Bsdf const& b = at.bsdf;
    if (!may_mirror(b)) return false;
    BsdfSample lobes[3];
    int const n = delta_lobes(b, wo, at.front, lobes);
    float most = 0.5f * luminance(albedo(b));
    bool found = false;
    for (int k = 0; k < n; ++k) {
        float l = luminance(lobes[k].weight);
        if (lobes[k].transmitted && !b.thin) l *= at.front ? square(b.ior) : 1 / square(b.ior); // power
        if (!(l > most)) continue;
        vec3 const on = at.frame.to_world(lobes[k].wi);
        if ((glm::dot(on, at.geometric_normal) > 0) != (lobes[k].wi.z > 0)) continue;
        most = l;
        lobe = lobes[k];
        found = true;
    }
    return found;
}

} // namespace gi
