#include "gi/hit_buffers/shadow_maps/shadow_map.h"

#include "gi/raster/deep_raster.h"

#include <algorithm>

namespace gi {

ShadowPlace ShadowMap::look(vec3 position, vec3 normal, vec2 u) const
{
    return shadow_detail::look(*this, position, normal, u);
}

bool ShadowMap::lit(Place const& place, View<Surface const> surfaces, vec3 position, std::uint32_t triangle) const
{
    return shadow_detail::lit(*this, place, surfaces, position, triangle);
}

bool ShadowMap::shows(vec3 position, vec3 normal, std::uint32_t first) const
{
    for (int k = 0; k < 4; ++k) {
        NearestTexel const* const texel = look(position, normal, vec2{float(k & 1), float(k >> 1)}).texel;
        if (texel != nullptr && texel->primitive != kNoPrimitive && texel->primitive >= first) return true;
    }
    return false;
}

LitBy ShadowMap::lit_by(Place const& drawn, View<Surface const> surfaces, vec3 position, vec3 normal,
                        std::uint32_t triangle) const
{
    return shadow_detail::lit_by(*this, drawn, surfaces, position, normal, triangle);
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
        map.levels = int(windows_.size()) + 1;
        map.grids[0] = make_grid(bounds_, -view.at, resolution_, jitter, turn_rad);
        for (std::size_t k = 0; k < windows_.size(); ++k)
            map.grids[k + 1] = make_window(windows_[k], bounds_, -view.at, resolution_, jitter, turn_rad);
        return;
    }
    float const near_m = 1e-5f * glm::max(bounds_.radius(), 1e-30f);
    for (int f = 0; f < 6; ++f) map.faces[std::size_t(f)] = cube_face(view.at, f, resolution_, near_m);
}

void ShadowMapBuilder::draw(int face, std::size_t first, std::size_t last, std::uint32_t seed,
                            ShadowMap const& map, Fragments& fragments) const
{
    if (map.parallel) {
        RasterGrid const& g = map.grids[std::size_t(face)];
        rasterize(soup_, first, last, g, MacroPath::edge_table, fragments);
        cut_outs_.remove(fragments, g, seed);
    } else {
        PerspectiveGrid const& g = map.faces[std::size_t(face)];
        rasterize(soup_, first, last, g, fragments);
        cut_outs_.remove(fragments, g, seed);
    }
}

namespace {

float key_sign(ShadowMap const& map) { return map.parallel ? -1.0f : 1.0f; }

} // namespace

void ShadowMapBuilder::build(ShadowView const& view, int face, std::size_t last, std::uint32_t seed,
                             ShadowMap& map) const
{
    PerspectiveGrid const& g = map.faces[std::size_t(face)];
    if (view.parallel ? face >= map.levels : sees_only_dark(view, g)) return;
    BorrowedFragments drawn;
    draw(face, 0, last, seed, map, *drawn);
    NearestMap& nearest = map.maps[std::size_t(face)];
    if (view.parallel)
        clear(nearest, map.grids[std::size_t(face)].width, map.grids[std::size_t(face)].height);
    else
        clear(nearest, g.width, g.height);
    resolve(*drawn, key_sign(map), nearest);
}

void ShadowMapBuilder::move(int face, std::size_t first, std::uint32_t seed, ShadowMap& map,
                            TakenTexels& taken) const
{
    NearestMap& nearest = map.maps[std::size_t(face)];
    auto& under = taken[std::size_t(face)];
    for (auto const& [at, texel] : under) nearest.texels[at] = texel;
    under.clear();
    if (nearest.texels.empty() || first == soup_.count) return;
    BorrowedFragments drawn;
    draw(face, first, soup_.count, seed, map, *drawn);
    for (std::size_t k = 0; k < drawn->count; ++k)
        under.emplace_back(drawn->texel[k], nearest.texels[drawn->texel[k]]);
    resolve(*drawn, key_sign(map), nearest);
}

void ShadowMapBuilder::swap_moving(int face, bool back, ShadowMap& map, TakenTexels& taken)
{
    NearestMap& nearest = map.maps[std::size_t(face)];
    auto& under = taken[std::size_t(face)];
    // A texel may be listed several times; only its first entry holds the original content.
    auto const swap = [&](auto& entry) { std::swap(nearest.texels[entry.first], entry.second); };
    if (back)
        std::for_each(under.rbegin(), under.rend(), swap);
    else
        std::for_each(under.begin(), under.end(), swap);
}

} // namespace gi
