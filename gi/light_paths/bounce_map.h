#pragma once
// Bounce maps (McGuire and Luebke 2009; Norén and Sjölin 2010, sec. 5.1): the first surfaces of light paths are
// not found by rays but rasterised as seen from points of the lights. Each texel is a light path; what it has met
// is a reflective shadow map (Dachsbacher and Stamminger 2005), its continuation is the bounce map.
//
// A set has a few dozen views: from points drawn on the lights (cubes in random turns), along directions of
// parallel lights and the sky; with a focus, half of these show its surroundings alone. So paths of one view share
// a point of the light; sets differ.

#include "gi/light_paths/light_path_step.h"
#include "gi/light_paths/light_paths.h"
#include "gi/raster/cut_outs.h"

namespace gi {

/// One raster seen from a light.
struct LightView {
    bool parallel = false;
    PerspectiveGrid face; ///< of a cube around a point, turned
    RasterGrid grid;      ///< along a parallel light
    vec3 light{0};        ///< parallel: W a texel; point: radiant intensity, of a surface across its normal, W/sr
    vec3 normal{0};       ///< of an emitting surface; 0 = a point
    bool both_sides = false;
    Light spot; ///< its cone and range
    bool is_spot = false;
    float paths = 1; ///< of its light that are expected
    float views = 1; ///< of its light that are expected, with this one
    float area = 0;  ///< see EmittedLight
    /// Of a parallel light with a focus: its texels lie in the cylinder about the focus's sphere, or beside it.
    vec3 focus_center{0};
    float focus_radius = 0;  ///< m; 0 = no focus
    bool through = false;    ///< in the cylinder
    std::uint32_t first = 0; ///< number of the path of its first texel

    GI_FN std::uint32_t width() const { return parallel ? grid.width : face.width; }
    GI_FN std::uint32_t height() const { return parallel ? grid.height : face.height; }
};

enum class Bounce : std::uint8_t {
    none,      ///< no surface was hit, or the light was absorbed
    scattered, ///< by a Lambertian or glossy lobe
    mirrored,
    transmitted
};

/// A texel of a bounce map, as in table 2 of the paper.
struct BounceTexel {
    vec3 power{0};          ///< W, after the bounce
    float ior = 1;          ///< of the surface
    float path_density = 0; ///< 1/m^2, see LightVertex::footprint
    vec3 direction{0};      ///< unit, in which the light leaves
    float depth = 0;        ///< m, along the ray from the light; parallel light: along its axis
    std::uint32_t triangle = kNoTriangle;
    Bounce bounce = Bounce::none;
};

/// Power of a texel's light, W.  @param out  its path, before its first surface
GI_FN inline void start_at_texel(LightView const& view, std::uint32_t texel, LightPath& out)
{
    std::uint32_t const i = texel % view.width(), j = texel / view.width();
    if (view.parallel) {
        out.light.ray.direction = view.grid.axis;
        out.area = view.area;
        vec3 const way = view.grid.point(i, j, 0) - view.focus_center;
        vec3 const beside = way - glm::dot(way, view.grid.axis) * view.grid.axis;
        bool const in_cylinder = glm::dot(beside, beside) < square(view.focus_radius);
        out.light.power = in_cylinder == view.through ? view.light : vec3{0};
        return;
    }
    // The solid angle of a texel, by the rectangle's closed form, so that all together are 4 pi.
    float const n = float(view.face.width);
    auto const corner = [&](std::uint32_t x, std::uint32_t y) {
        float const a = 2 * float(x) / n - 1, b = 2 * float(y) / n - 1;
        return std::atan2(a * b, std::sqrt(a * a + b * b + 1));
    };
    float const solid_angle = corner(i + 1, j + 1) - corner(i, j + 1) - corner(i + 1, j) + corner(i, j);
    vec3 const direction = glm::normalize(view.face.direction(i, j));
    out.light.ray = {view.face.eye, direction};
    out.light.power = solid_angle * view.light;
    out.light.range = view.spot.range;
    out.solid_angle = solid_angle / view.views;
    if (view.is_spot) {
        float const z = glm::dot(direction, view.spot.direction);
        out.light.power *= light_detail::cone_attenuation(view.spot, z);
    } else if (view.normal != vec3{0}) {
        float const cosine = glm::dot(direction, view.normal);
        out.light.power *= view.both_sides ? glm::abs(cosine) : glm::max(cosine, 0.0f);
    }
    out.area = view.area;
}

/// Item = texel of a view. Starts a light path at the surface visible in this texel.
struct BounceTexels {
    WorldView world;
    LightView view;
    LightPathSet set;
    LightPathRules rules;
    View<NearestTexel const> seen;
    View<BounceTexel> texels;   ///< contents of the bounce map; may be empty, as paths do not need it
    View<LightPath> paths;      ///< continuations of the paths; power 0 = ended
    View<LightVertex> vertices; ///< of the reflective shadow map
    View<std::uint8_t> has_vertex;

    GI_FN void operator()(std::size_t k) const
    {
        BounceTexel out;
        LightPath p;
        has_vertex[k] = 0;
        auto const texel = std::uint32_t(k);
        NearestTexel const nearest = seen[k];
        p.number = view.first + texel;
        p.rng = Pcg32::for_path(set.seed ^ 0xb0c, p.number, set.pass);
        p.paths = view.paths;
        if (nearest.primitive != kNoPrimitive) {
            start_at_texel(view, texel, p);
            vec3 const arrives = p.light.ray.direction;
            std::uint32_t const i = texel % view.width(), j = texel / view.width();
            float const key = nearest.key;
            vec3 const at = view.parallel ? view.grid.point(i, j, -key) : view.face.point(i, j, key);
            out.depth = view.parallel ? -key : glm::length(at - view.face.eye);
            out.triangle = nearest.primitive;
            Hit const hit{nearest.primitive, barycentric_at(world.surfaces[nearest.primitive], at),
                          view.parallel ? 0.0f : out.depth};
            bool left = false;
            bool const goes_on = advance(
                world, rules, p, hit, [](vec3, std::uint32_t) { return true; }, vertices[k], left);
            has_vertex[k] = left ? 1 : 0;
            if (left) out.path_density = 1 / vertices[k].footprint;
            if (!goes_on) p.light.power = vec3{0};
            out.power = p.light.power;
            out.direction = p.light.ray.direction;
            Surface const& surface = world.surfaces[hit.triangle];
            out.ior = world.bsdfs[surface.material].ior;
            vec3 const normal = glm::cross(surface.edge1, surface.edge2);
            bool const through = glm::dot(normal, arrives) * glm::dot(normal, out.direction) > 0;
            out.bounce = !goes_on      ? Bounce::none
                         : !p.by_delta ? Bounce::scattered
                         : through     ? Bounce::transmitted
                                       : Bounce::mirrored;
        } else {
            p.light.power = vec3{0};
        }
        if (!texels.empty()) texels[k] = out;
        paths[k] = p;
    }
};

/// Views of a set with about s.count texels in all. @param views  how many points and directions of lights
std::vector<LightView> light_views(WorldView const& world, Bounds const& bounds, LightPaths const& s,
                                   int views = 32);
/// What is seen in a view. @param soup  of the world
std::vector<NearestTexel> draw_light_view(WorldView const& world, TriangleSoup const& soup, LightView const& view,
                                          CutOuts const& cut_outs, std::uint32_t seed);
/// As trace_light_paths(), with first surfaces from bounce maps: the vertices of a whole set, view by view.
/// @param found  called with some after the others, and the share of the set's texels that have been drawn
void trace_bounce_maps(WorldView const& world, Bounds const& bounds, TriangleSoup const& soup,
                       CutOuts const& cut_outs, PathRays const& rays, LightPaths const& s, PathCounts& counts,
                       std::function<void(std::span<LightVertex const>, double share)> const& found);

} // namespace gi
