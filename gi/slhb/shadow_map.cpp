#include "gi/slhb/shadow_map.h"

#include "gi/raster/deep_raster.h"

namespace gi {

ShadowPlace ShadowMap::look(vec3 position, vec3 normal, vec2 u) const
{
    return shadow_detail::look(*this, position, normal, u);
}

bool ShadowMap::lit(Place const& place, View<Surface const> surfaces, vec3 position, std::uint32_t triangle) const
{
    return shadow_detail::lit(*this, place, surfaces, position, triangle);
}

bool sees_only_dark(ShadowView const& view, PerspectiveGrid const& face)
{
    if (view.facing == vec3{0}) return false;
    float const within = glm::dot(view.facing, face.forward);
    float const across =
        std::abs(view.facing.x) + std::abs(view.facing.y) + std::abs(view.facing.z) - std::abs(within);
    return within + across <= 0;
}

void ShadowMapBuilder::start(ShadowView const& view, vec2 jitter, float turn_rad, ShadowMap& map) const
{
    map.parallel = view.parallel;
    for (NearestMap& m : map.maps) m.texels.clear();
    if (view.parallel) {
        map.grid = make_grid(bounds_, -view.at, resolution_, jitter, turn_rad);
        return;
    }
    float const near_m = 1e-5f * glm::max(bounds_.radius(), 1e-30f);
    for (int f = 0; f < 6; ++f) map.faces[std::size_t(f)] = cube_face(view.at, f, resolution_, near_m);
}

void ShadowMapBuilder::build(ShadowView const& view, int face, std::uint32_t seed, ShadowMap& map) const
{
    thread_local Fragments fragments;
    fragments.count = 0;
    NearestMap& nearest = map.maps[std::size_t(face)];
    if (view.parallel) {
        if (face != 0) return;
        rasterize(soup_, 0, soup_.count, map.grid, MacroPath::edge_table, fragments);
        cut_outs_.remove(fragments, map.grid, seed);
        clear(nearest, map.grid.width, map.grid.height);
        resolve(fragments, -1, nearest);
        return;
    }
    PerspectiveGrid const& g = map.faces[std::size_t(face)];
    if (sees_only_dark(view, g)) return;
    rasterize(soup_, 0, soup_.count, g, fragments);
    cut_outs_.remove(fragments, g, seed);
    clear(nearest, g.width, g.height);
    resolve(fragments, 1, nearest);
}

} // namespace gi
