#pragma once
// Questions about the materials that some surface has. Materials without a surface cost nothing.

#include "gi/scene/model/world.h"

#include <algorithm>

namespace gi {

/// True if some triangle has a material for which it holds. @param holds  (Material, Bsdf) -> bool
template <class Predicate>
bool uses_material(World const& world, Predicate const& holds)
{
    std::vector<char> held(world.materials.size());
    bool any = false;
    for (std::size_t m = 0; m < held.size(); ++m) {
        held[m] = holds(world.materials[m], world.bsdfs[m]) ? 1 : 0;
        any = any || held[m] != 0;
    }
    return any && std::ranges::any_of(world.triangle_material, [&](std::uint32_t m) { return held[m] != 0; });
}

/// True if some surface is a pane, see is_pane.
inline bool has_panes(World const& world)
{
    return uses_material(world, [](Material const& m, Bsdf const&) { return is_pane(m); });
}

} // namespace gi
