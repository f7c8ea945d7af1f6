#pragma once
// Shadow map look-ups on the CPU and in kernels, for any type with `parallel`, `grids`, `levels`, `faces` and texels(face),
// like ShadowMap and ShadowMapView. shadow_map.h describes how a look-up decides.

#include "gi/raster/nearest_map.h"

namespace gi {

/// The shadow map texel chosen for a point.
struct ShadowPlace {
    NearestTexel const* texel = nullptr; ///< null = nothing can block the light
    float depth = 0;                     ///< of the lit surface at the texel's centre, m
    float side = 0;                      ///< width of the texel at that depth, m
};

/// A ShadowMap that kernels can read.
struct ShadowMapView {
    bool parallel = false;
    int levels = 1;
    RasterGrid grids[6];
    PerspectiveGrid faces[6];
    NearestTexel const* maps[6] = {}; ///< null = empty

    GI_FN NearestTexel const* texels(std::size_t face) const { return maps[face]; }
};

/// What the four texels around a point say of the light.
enum class LitBy : std::uint8_t { none, some, all };

namespace shadow_detail {

/// Picks a texel coordinate around a point with the probability of its (bi)linear weight.
GI_FN inline std::uint32_t pick(float at, float u, std::uint32_t count)
{
    float const shifted = std::floor(at - 0.5f + u);
    return shifted > 0 ? glm::min(std::uint32_t(shifted), count - 1) : 0u;
}

GI_FN inline int face_of(vec3 d)
{
    vec3 const a = glm::abs(d);
    if (a.x >= a.y && a.x >= a.z) return d.x < 0 ? 1 : 0;
    if (a.y >= a.z) return d.y < 0 ? 3 : 2;
    return d.z < 0 ? 5 : 4;
}

/// @param normal  unit, of the lit triangle  @param u uniform in [0, 1)^2
template <class Map>
GI_FN ShadowPlace look(Map const& map, vec3 position, vec3 normal, vec2 u)
{
    // Depth offset to where the line through the texel's centre meets the lit surface's plane, limited as on a
    // surface seen at a steep grazing angle.
    constexpr float kSteepest = 8;
    auto const shift = [&](vec3 off, vec3 line, float texel) {
        float const cosine = glm::dot(normal, line), most = kSteepest * texel;
        return cosine != 0 ? glm::clamp(glm::dot(normal, off) / cosine, -most, most) : 0.0f;
    };
    if (map.parallel) {
        auto level = std::size_t(map.levels) - 1;
        while (level > 0 && !map.grids[level].holds(position)) --level;
        RasterGrid const& grid = map.grids[level];
        float const x = (glm::dot(position, grid.right) - grid.corner.x) / grid.texel;
        float const y = (glm::dot(position, grid.up) - grid.corner.y) / grid.texel;
        std::uint32_t const i = pick(x, u.x, grid.width), j = pick(y, u.y, grid.height);
        float const here = grid.depth(position);
        return {map.texels(level) + (std::size_t(j) * grid.width + i),
                here + shift(position - grid.point(i, j, here), grid.axis, grid.texel), grid.texel};
    }
    vec3 const way = position - map.faces[0].eye;
    auto const f = std::size_t(face_of(way));
    PerspectiveGrid const& g = map.faces[f];
    NearestTexel const* const texels = map.texels(f);
    float const w = glm::dot(g.forward, way);
    if (texels == nullptr || !(w > g.near_m)) return {}; // behind a one-sided light, or at the light itself
    float const per_subpixel = 1 / (w * g.subpixels);
    std::uint32_t const i = pick(glm::dot(g.to_x, way) * per_subpixel, u.x, g.width);
    std::uint32_t const j = pick(glm::dot(g.to_y, way) * per_subpixel, u.y, g.height);
    vec3 const line = g.direction(i, j);
    float const texel = 2 * w / float(g.width);
    return {texels + (std::size_t(j) * g.width + i), w + shift(way - w * line, line, texel), texel};
}

/// @param triangle  the lit triangle, at `position`
template <class Map>
GI_FN bool lit(Map const& map, ShadowPlace const& place, View<Surface const> surfaces, vec3 position,
               std::uint32_t triangle)
{
    constexpr float kRounding = 1e-5f, kNear = 4; // relative to the depth; in texels
    // How far a finely tessellated surface may rise above its own plane within a texel.
    constexpr float kBumps = 0.1f, kAlike = 0.8f; // in texels; cosine between the triangles' normals
    if (place.texel == nullptr || place.texel->primitive == triangle || place.texel->primitive == kNoPrimitive)
        return true;
    float const stored = map.parallel ? -place.texel->key : 1 / place.texel->key;
    float const gap = place.depth - stored;
    if (gap <= kRounding * std::abs(place.depth)) return true;
    if (gap > kNear * place.side) return false;
    Surface const& s = surfaces[place.texel->primitive];
    vec3 const normal = glm::cross(s.edge1, s.edge2);
    float const here = glm::dot(normal, position - s.corner);
    float const light_point =
        map.parallel ? -glm::dot(normal, map.grids[0].axis) : glm::dot(normal, map.faces[0].eye - s.corner);
    if ((here < 0) == (light_point < 0) || std::abs(here) <= s.clearance * glm::length(normal)) return true;
    if (gap > kBumps * place.side) return false;
    vec3 const own = glm::cross(surfaces[triangle].edge1, surfaces[triangle].edge2);
    return glm::dot(own, normal) > kAlike * glm::length(own) * glm::length(normal);
}

/// Where something blended blocks the light of some, all say what the drawn one does: it is in a texel or not by lot.
/// @param drawn  one of them  @param normal  unit, of the lit triangle, at `position`
template <class Map>
GI_FN LitBy lit_by(Map const& map, ShadowPlace const& drawn, View<Surface const> surfaces, vec3 position,
                   vec3 normal, std::uint32_t triangle)
{
    int n = 0;
    bool by_lot = false;
    for (int k = 0; k < 4; ++k) {
        ShadowPlace const place = look(map, position, normal, vec2{float(k & 1), float(k >> 1)});
        if (lit(map, place, surfaces, position, triangle))
            ++n;
        else
            by_lot = by_lot || surfaces[place.texel->primitive].is(Surface::kBlended);
    }
    if (by_lot) return lit(map, drawn, surfaces, position, triangle) ? LitBy::all : LitBy::none;
    return n == 0 ? LitBy::none : n == 4 ? LitBy::all : LitBy::some;
}

} // namespace shadow_detail
} // namespace gi
