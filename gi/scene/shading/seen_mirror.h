#pragma once
// Surfaces that show other surfaces: mirrors and panes, whose strongest delta lobe leaves more of the light than
// half of their albedo. Pictures are described by what is seen in these (gi/surfaces).

#include "gi/scene/shading/shading_point.h"

namespace gi {

/// Mirrors and panes that are followed, one behind the other.
inline constexpr int kMostMirrors = 6;

/// False if a material has no delta lobe.
GI_FN inline bool may_mirror(Bsdf const& b)
{
    return b.clear > 0 || (!bsdf_detail::is_matt(b) && b.f90.x > 0 && bsdf_detail::specular_is_delta(b));
}

/// Finds the lobe by which a mirror or pane shows other surfaces; its other lobes only add light.
/// @param wo  local  @return number of lobes, the one that is shown first; 0: the surface itself is seen
GI_FN inline int find_mirror(ShadingPoint const& at, vec3 wo, BsdfSample lobes[3])
{
    Bsdf const& b = at.bsdf;
    if (!may_mirror(b)) return 0;
    BsdfSample all[3];
    int const n = delta_lobes(b, wo, at.front, all);
    float most = 0.5f * luminance(albedo(b));
    int shown = -1, count = 0;
    for (int k = 0; k < n; ++k) {
        vec3 const on = at.frame.to_world(all[k].wi);
        if ((glm::dot(on, at.geometric_normal) > 0) != (all[k].wi.z > 0)) continue;
        lobes[count++] = all[k];
        float l = luminance(all[k].weight);
        if (all[k].transmitted && !b.thin) l *= at.front ? square(b.ior) : 1 / square(b.ior); // power
        if (!(l > most)) continue;
        most = l;
        shown = count - 1;
    }
    if (shown < 0) return 0;
    BsdfSample const first = lobes[0];
    lobes[0] = lobes[shown];
    if (shown > 0) lobes[shown] = first;
    return count;
}

} // namespace gi
