#pragma once
// Coloured glass and liquids: what absorbs inside of closed surfaces (KHR_materials_volume), on CPU and GPU. A path keeps
// the material that it is in. Shadow rays end at such surfaces, so they need no medium.

#include "gi/scene/shading/shading_point.h"

namespace gi {

/// Outside of all that absorbs.
inline constexpr std::uint32_t kNoMedium = 0xffffffffu;

/// True if the way to a surface may be one through a medium. @param medium  of the way, or kNoMedium
GI_FN inline bool may_absorb(std::uint32_t medium, ShadingPoint const& at)
{
    return medium != kNoMedium || (!at.front && !at.bsdf.thin && at.bsdf.clear > 0);
}

/// Share of light that is left after a way through a medium (Beer and Lambert). What meets glass from behind without
/// having entered it, as it began inside or left glass within glass, has passed through that.
/// @param medium    material of the way, or kNoMedium
/// @param triangle, at  where it ends  @param distance  its length, m
GI_FN inline vec3 left_by_medium(WorldView const& world, std::uint32_t medium, std::uint32_t triangle,
                                 ShadingPoint const& at, float distance)
{
    if (!may_absorb(medium, at)) return vec3{1};
    if (medium == kNoMedium) medium = world.surfaces[triangle].material;
    return glm::exp(-distance * world.materials[medium].absorption);
}

/// What a path is in after it has left a surface. @param medium  on arrival
GI_FN inline std::uint32_t medium_beyond(WorldView const& world, std::uint32_t medium, std::uint32_t triangle,
                                         ShadingPoint const& at, BsdfSample const& next)
{
    if (!next.transmitted || at.bsdf.thin) return medium;
    std::uint32_t const material = world.surfaces[triangle].material;
    return at.front && max_component(world.materials[material].absorption) > 0 ? material : kNoMedium;
}

} // namespace gi
