#include "gi/slhb/shadow_map.h"

#include "gi/raster/deep_raster.h"

namespace gi {
namespace {

/// Of the four texels around a point, one with the probability of its bilinear weight.
std::uint32_t pick(float at, float u, std::uint32_t count)
{
    float const shifted = std::floor(at - 0.5f + u);
    return shifted > 0 ? std::min(std::uint32_t(shifted), count - 1) : 0u;
}

int face_of(vec3 d)
{
    vec3 const a = glm::abs(d);
    int const axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return 2 * axis + (d[axis] < 0 ? 1 : 0);
}

} // namespace

ShadowMap::Place ShadowMap::look(vec3 position, vec3 normal, vec2 u) const
{
    // Where the surface is met by the line through the texel's centre, no farther from the point than a surface
    // that is grazed steeply would be.
    constexpr float kSteepest = 8;
    auto const shift = [&](vec3 off, vec3 line, float texel) {
        float const cosine = glm::dot(normal, line), most = kSteepest * texel;
        return cosine != 0 ? glm::clamp(glm::dot(normal, off) / cosine, -most, most) : 0.0f;
    };
    if (parallel) {
        float const x = (glm::dot(position, grid.right) - grid.corner.x) / grid.texel;
        float const y = (glm::dot(position, grid.up) - grid.corner.y) / grid.texel;
        std::uint32_t const i = pick(x, u.x, grid.width), j = pick(y, u.y, grid.height);
        float const here = grid.depth(position);
        return {&maps[0].texels[std::size_t(j) * grid.width + i],
                here + shift(position - grid.point(i, j, here), grid.axis, grid.texel), grid.texel};
    }
    vec3 const way = position - faces[0].eye;
    auto const f = std::size_t(face_of(way));
    PerspectiveGrid const& g = faces[f];
    float const w = glm::dot(g.forward, way);
    if (maps[f].texels.empty() || !(w > g.near_m))
        return {}; // behind a lamp that shines to one side, or at the lamp
    float const per_subpixel = 1 / (w * g.subpixels);
    std::uint32_t const i = pick(glm::dot(g.to_x, way) * per_subpixel, u.x, g.width);
    std::uint32_t const j = pick(glm::dot(g.to_y, way) * per_subpixel, u.y, g.height);
    vec3 const line = g.direction(i, j);
    float const texel = 2 * w / float(g.width);
    return {&maps[f].texels[std::size_t(j) * g.width + i], w + shift(way - w * line, line, texel), texel};
}

bool ShadowMap::lit(Place const& place, View<Surface const> surfaces, vec3 position, std::uint32_t triangle) const
{
    constexpr float kRounding = 1e-5f, kNear = 4; // of the depth; texels
    if (place.texel == nullptr || place.texel->primitive == triangle || place.texel->primitive == kNoPrimitive)
        return true;
    float const stored = parallel ? -place.texel->key : 1 / place.texel->key;
    float const gap = place.depth - stored;
    if (gap <= kRounding * std::abs(place.depth)) return true;
    if (gap > kNear * place.side) return false;
    Surface const& s = surfaces[place.texel->primitive];
    vec3 const normal = glm::cross(s.edge1, s.edge2);
    float const here = glm::dot(normal, position - s.corner);
    float const lamp = parallel ? -glm::dot(normal, grid.axis) : glm::dot(normal, faces[0].eye - s.corner);
    return (here < 0) == (lamp < 0) || std::abs(here) <= s.clearance * glm::length(normal);
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
    // A face whose every direction points behind the lamp sees nothing that it could light.
    if (view.facing != vec3{0}) {
        float const within = glm::dot(view.facing, g.forward);
        float const across =
            std::abs(view.facing.x) + std::abs(view.facing.y) + std::abs(view.facing.z) - std::abs(within);
        if (within + across <= 0) return;
    }
    rasterize(soup_, 0, soup_.count, g, fragments);
    cut_outs_.remove(fragments, g, seed);
    clear(nearest, g.width, g.height);
    resolve(fragments, 1, nearest);
}

} // namespace gi
