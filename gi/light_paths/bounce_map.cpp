#include "gi/light_paths/bounce_map.h"

#include "gi/raster/draw_nearest.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

template <class Grid>
std::vector<NearestTexel> draw(WorldView const& world, TriangleSoup const& soup, Grid const& grid,
                               CutOuts const& cut_outs, std::uint32_t seed)
{
    SoupView const triangles = view(soup);
    return download(cut_outs.none()
                        ? draw_nearest<Space::host>(triangles, grid)
                        : draw_nearest<Space::host>(triangles, grid, seed, KeepUncut{world, cut_outs.marked()}));
}

/// The six faces of a cube around a point, without those that only light's dark side sees.
void add_cube(LightView const& v, vec3 eye, float near_m, std::uint32_t resolution, Frame const& turn,
              std::vector<LightView>& out)
{
    mat3 const rotation{turn.tangent, turn.bitangent, turn.normal};
    for (int face = 0; face < 6; ++face) {
        LightView seen = v;
        PerspectiveGrid& g = seen.face;
        g = cube_face(eye, face, resolution, near_m);
        g.to_x = rotation * g.to_x;
        g.to_y = rotation * g.to_y;
        g.forward = rotation * g.forward;
        g.inverse = rotation * g.inverse;
        bool lit = v.normal == vec3{0} || v.both_sides;
        for (int corner = 0; corner < 4 && !lit; ++corner)
            lit = glm::dot(
                      g.direction((corner & 1) != 0 ? resolution - 1 : 0, (corner & 2) != 0 ? resolution - 1 : 0),
                      v.normal) > 0;
        if (lit) out.push_back(seen);
    }
}

/// The part of distant light that a view shows, see LightPaths::focus.
struct FocusPart {
    vec3 center{0};
    float radius = 0; ///< m; 0 = all
    bool through = false;

    float share() const { return radius > 0 ? 0.5f : 1.0f; } ///< of the views
};

/// True if grids about a focus have fine enough subpixels for triangles of the whole world.
bool fits_grid(Bounds const& focus, Bounds const& world, float texels)
{
    constexpr float kMost = 1 << (RasterGrid::kCoordinateBits - 5); // texels along the world
    return focus.radius() > 0 && std::sqrt(texels) * world.radius() < kMost * focus.radius();
}

/// Grid over a sphere, in which triangles of the world beyond it can be drawn.
RasterGrid grid_about(FocusPart const& focus, Bounds const& world, vec3 axis, std::uint32_t resolution,
                      vec2 jitter, float turn_rad)
{
    // The smallest of the boxes along the grid's axes that cover the sphere.
    auto const reach = [](vec3 v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
    RasterGrid const turned = make_grid({}, axis, resolution, jitter, turn_rad);
    float const half = focus.radius / std::min(reach(turned.right), reach(turned.up));
    RasterGrid g = make_grid({focus.center - half, focus.center + half}, axis, resolution, jitter, turn_rad);
    constexpr float kMost = 1 << RasterGrid::kCoordinateBits; // subpixels
    while (g.subpixels > 1 && 2.01f * world.radius() / g.texel * g.subpixels > kMost) g.subpixels /= 2;
    float const scale = g.subpixels / g.texel;
    g.to_x = scale * g.right;
    g.to_y = scale * g.up;
    g.x0 = -scale * g.corner.x;
    g.y0 = -scale * g.corner.y;
    g.rounding = 1e-6f * (glm::length(world.center()) + world.radius());
    return g;
}

/// Views from a point of an emitting triangle or a punctual light, or along a direction. @param texels  of all
void add_views(WorldView const& world, Bounds const& bounds, LightChoice choice, std::uint32_t views, float texels,
               FocusPart const& focus, Pcg32& rng, std::vector<LightView>& out)
{
    LightView v;
    float const share = 1 / (choice.probability * float(views));
    v.views = float(views) * world.light_select.probability(choice.light);
    v.paths = texels * v.views;
    v.views = std::max(1.0f, v.views);
    auto const parallel = [&](vec3 travels, vec3 irradiance) {
        v.parallel = true;
        auto const side = std::uint32_t(std::sqrt(texels));
        vec2 const jitter = rng.uniform2();
        float const turn = 2 * kPi * rng.uniform();
        v.grid = focus.radius > 0 && focus.through ? grid_about(focus, bounds, travels, side, jitter, turn)
                                                   : make_grid(bounds, travels, side, jitter, turn);
        v.focus_center = focus.center;
        v.focus_radius = focus.radius;
        v.through = focus.through;
        v.light = irradiance * (square(v.grid.texel) / focus.share());
        v.area = square(v.grid.texel) / std::max(1.0f, v.views * focus.share()); // its views lie over each other
        out.push_back(v);
    };
    auto const cube = [&](vec3 eye, float near_m, float faces) {
        float const side = std::sqrt(texels / faces);
        float const z = 1 - 2 * rng.uniform(), r = std::sqrt(std::max(0.0f, 1 - z * z));
        vec2 const turn = azimuth(rng.uniform());
        add_cube(v, eye, near_m, std::uint32_t(std::max(side, 1.0f)), Frame::about({r * turn.x, r * turn.y, z}),
                 out);
    };
    if (light_detail::is_environment(world, choice)) {
        LightSample const s = sample_light(world, choice, bounds.center(), rng.uniform2());
        if (s.pdf > 0) parallel(-s.direction, s.radiance / (s.pdf * float(views)));
        return;
    }
    std::size_t const lights = world.lights.size();
    if (choice.light < lights) {
        Light const& light = world.lights[choice.light];
        if (light.type == LightType::directional) return parallel(light.direction, light.intensity * share);
        v.light = light.intensity * share;
        v.spot = light;
        v.is_spot = light.type == LightType::spot;
        return cube(light.position, 1e-6f * bounds.radius(), 6);
    }
    std::uint32_t const triangle = world.emitters[choice.light - lights];
    vec2 const place = rng.uniform2();
    EmittedLight const e = emit_light(world, choice, bounds, place, vec2{0.5f}, 0.5f);
    Surface const& surface = world.surfaces[triangle];
    vec3 const eye = shading_detail::SurfacePoint{surface, square_to_triangle(place)}.position();
    v.both_sides = surface.is(Surface::kDoubleSided);
    v.normal = shading_detail::triangle_normal(surface);
    v.area = e.area / v.paths;
    v.light = e.power / ((v.both_sides ? 2 : 1) * kPi * float(views));
    cube(eye, surface.clearance, v.both_sides ? 6 : 4);
}

} // namespace

std::vector<LightView> light_views(WorldView const& world, Bounds const& bounds, LightPaths const& s, int views)
{
    std::vector<LightView> out;
    if (world.light_select.empty() || bounds.empty()) return out;
    auto const n = std::uint32_t(std::clamp(views, 1, int(std::max(1u, s.count / 64))));
    FocusPart focus;
    if (fits_grid(s.focus, bounds, float(s.count) / float(n)))
        focus = {s.focus.center(), 1.001f * s.focus.radius(), false};
    // Alternates, so that both parts have views of each light; the first part is random.
    std::uint32_t const first_part = Pcg32::for_path(s.seed ^ 0xb0cf0c, n, s.pass).uniform() < 0.5f ? 0 : 1;
    for (std::uint32_t k = 0; k < n; ++k) {
        focus.through = focus.radius > 0 && (k + first_part) % 2 == 0;
        Pcg32 rng = Pcg32::for_path(s.seed ^ 0xb0c3a9, k, s.pass);
        LightChoice const choice = choose_light(world, (double(k) + rng.uniform_double()) / double(n));
        if (choice.probability > 0)
            add_views(world, bounds, choice, n, float(s.count) / float(n), focus, rng, out);
    }
    std::uint32_t first = 0;
    for (LightView& v : out) {
        v.first = first;
        first += v.width() * v.height();
    }
    return out;
}

std::vector<NearestTexel> draw_light_view(WorldView const& world, TriangleSoup const& soup, LightView const& v,
                                          CutOuts const& cut_outs, std::uint32_t seed)
{
    return v.parallel ? draw(world, soup, v.grid, cut_outs, seed) : draw(world, soup, v.face, cut_outs, seed);
}

void trace_bounce_maps(WorldView const& world, Bounds const& bounds, TriangleSoup const& soup,
                       CutOuts const& cut_outs, PathRays const& rays, LightPaths const& s, PathCounts& counts,
                       std::function<void(std::span<LightVertex const>, double share)> const& found)
{
    if (s.bounces < 1) return;
    std::vector<LightView> const views = light_views(world, bounds, s);
    for (LightView const& v : views) {
        if (s.stop != nullptr && s.stop->given_up()) throw Interrupted();
        std::vector<NearestTexel> const seen = draw_light_view(world, soup, v, cut_outs, s.pass ^ v.first);
        std::size_t const n = seen.size();
        std::vector<LightPath> paths(n);
        std::vector<LightVertex> vertices(n);
        std::vector<std::uint8_t> has_vertex(n);
        launch_host(n, BounceTexels{world,
                                    v,
                                    {s.count, s.seed, s.pass},
                                    {s.bounces, s.delta_only},
                                    seen,
                                    {},
                                    paths,
                                    vertices,
                                    has_vertex});
        std::size_t left = 0;
        for (std::size_t k = 0; k < n; ++k)
            if (has_vertex[k] != 0) vertices[left++] = vertices[k];
        LightView const& last = views.back();
        double const share = double(v.first + n) / double(last.first + last.width() * last.height());
        found(std::span(vertices).first(left), share);
        found(trace_onwards(world, rays, paths, s, counts), share);
    }
}

} // namespace gi
