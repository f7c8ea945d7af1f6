// Light paths against closed forms: flux in closed rooms, form factors, path density;
// by rays, bounce maps and look-ups.

#include "gi/kernel/launch.h"
#include "gi/light_paths/bounce_map.h"
#include "gi/methods/path_rays/look_up_rays.h"
#include "gi/scene/model/world_on.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

namespace gi::test {
namespace {

LightPaths paths_of(std::uint32_t count, int bounces, std::uint32_t pass = 0)
{
    LightPaths s;
    s.count = count;
    s.bounces = bounces;
    s.pass = pass;
    return s;
}

enum class Way { rays, maps, look_ups };

std::vector<LightVertex> trace(Way way, World const& world, LightPaths const& s)
{
    ExactVisibility const visibility(world, false, 0);
    ExactPathRays const exact(visibility);
    PathCounts counts;
    if (way == Way::maps) {
        std::vector<LightVertex> all;
        trace_bounce_maps(
            view(world), world.bounds, make_soup(world), CutOuts(world), exact, s, counts,
            [&](std::span<LightVertex const> some, double) { all.insert(all.end(), some.begin(), some.end()); });
        return all;
    }
    if (way == Way::rays) return trace_light_paths(view(world), world.bounds, exact, s, counts);
    StoredAxes const axes(world, with_stored_axes({}), s.seed, ~std::size_t(0));
    return trace_light_paths(view(world), world.bounds, LookUpRays(world, axes, visibility), s, counts);
}

char const* name(Way way) { return way == Way::rays ? "rays" : way == Way::maps ? "bounce maps" : "look-ups"; }

Light punctual(LightType type, vec3 position)
{
    Light l;
    l.type = type;
    l.position = position;
    l.direction = glm::normalize(vec3{0.3f, -1, 0.2f});
    l.intensity = vec3{2};
    l.cos_inner = 0.9f;
    l.cos_outer = 0.7f;
    return l;
}

/// A closed room with one light: all of its flux meets a wall, then so much as the walls reflect, and so on.
TEST(LightPathsAnalytic, FluxInClosedRooms)
{
    constexpr float kAlbedo = 0.6f;
    for (int kind = 0; kind < 4; ++kind) {
        Scene scene;
        int const wall = add_material(scene, lambert(vec3{kAlbedo}));
        add_box(scene, {-1, -1, -1}, {1.5f, 1, 1}, wall, true);
        double flux = 0;
        if (kind == 0) {
            add_light(scene, punctual(LightType::point, {0.2f, 0.1f, -0.3f}));
            flux = 4 * double(kPi) * 2;
        } else if (kind == 1) {
            add_light(scene, punctual(LightType::spot, {0.2f, 0.8f, -0.3f}));
            constexpr int kSteps = 200000;
            Light const& l = scene.lights.back();
            for (int k = 0; k < kSteps; ++k) {
                double const z = 0.7 + 0.3 * (k + 0.5) / kSteps;
                flux += 2 * 2 * double(kPi) * 0.3 / kSteps * double(light_detail::cone_attenuation(l, float(z)));
            }
        } else {
            Material shining = emitter(vec3{3}, kind == 3);
            shining.base_color = vec3{kAlbedo};
            int const lamp = add_material(scene, shining);
            add_quad(scene, {-0.2f, 0.5f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, lamp); // shines downwards
            flux = 3 * double(kPi) * 0.16 * (kind == 3 ? 2 : 1);
        }
        World const world = world_of(scene);
        for (Way const way : {Way::rays, Way::maps}) {
            std::array<double, 5> found{};
            std::uint32_t const sets =
                kind == 1 && way == Way::rays ? 4 : 1; // of a spot, the share in its cone varies
            for (std::uint32_t set = 0; set < sets; ++set)
                for (LightVertex const& v : trace(way, world, paths_of(1 << 18, 5, set)))
                    if (v.scatterings < 5) found[std::size_t(v.scatterings)] += double(v.power.x) / sets;
            double expected = flux;
            for (std::size_t k = 0; k < found.size(); ++k, expected *= double(kAlbedo)) {
                fmt::print("light {} by {}: {} scatterings {:.5f} of the flux\n", kind, name(way), k,
                           found[k] / expected);
                EXPECT_NEAR(found[k] / expected, 1, k == 0 ? 0.001 : 0.012) << kind << name(way) << k;
            }
        }
    }
}

/// Share of a plate's light that reaches a parallel one, and a perpendicular one:
/// by photons within three standard errors.
TEST(LightPathsAnalytic, FormFactors)
{
    // Squares of side 1 at distance 1; squares of side 1 with a common edge.
    double const factors[] = {0.19982489569838746, 0.20004377607540316};
    for (int k = 0; k < 2; ++k)
        for (Way const way : {Way::rays, Way::maps}) {
            Scene scene;
            int const matt = add_material(scene, lambert(vec3{0.5f})),
                      lamp = add_material(scene, emitter(vec3{1}));
            add_quad(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, lamp); // faces +Y
            vec3 const u = k == 0 ? vec3{1, 0, 0} : vec3{0, 1, 0};
            add_quad(scene, {0, k == 0 ? 1 : 0, 0}, u, {0, 0, 1}, matt);
            World const world = world_of(scene);
            std::vector<double> shares;
            for (std::uint32_t set = 0; set < 16; ++set) {
                double flux = 0;
                for (LightVertex const& v : trace(way, world, paths_of(1 << 14, 1, set)))
                    flux += double(v.power.x);
                shares.push_back(flux / double(kPi));
            }
            double mean = 0, square_sum = 0;
            for (double const s : shares) mean += s / 16;
            for (double const s : shares) square_sum += (s - mean) * (s - mean);
            double const error = std::sqrt(square_sum / (16 * 15));
            fmt::print("form factor {} by {}: {:.5f} +- {:.5f}, in closed form {:.5f}\n", k, name(way), mean,
                       error, factors[k]);
            EXPECT_NEAR(mean, factors[k], 3 * error);
            EXPECT_LT(error, 0.006);
        }
}

/// Look-ups follow stored directions: what they bring is right but for these and the texels.
TEST(LightPathsAnalytic, LookUpsKeepFlux)
{
    Scene scene;
    int const wall = add_material(scene, lambert(vec3{0.6f}));
    add_box(scene, {-1, -1, -1}, {1.5f, 1, 1}, wall, true);
    add_light(scene, punctual(LightType::point, {0.2f, 0.1f, -0.3f}));
    World const world = world_of(scene);
    double floor[2] = {}, all[2] = {};
    for (Way const way : {Way::rays, Way::look_ups})
        for (LightVertex const& v : trace(way, world, paths_of(1 << 18, 6))) {
            std::size_t const k = way == Way::rays ? 0 : 1;
            all[k] += double(v.power.x);
            if (v.scatterings > 0 && v.normal.y > 0.5f) floor[k] += double(v.power.x);
        }
    fmt::print("look-ups: {:.4f} of the flux of rays, {:.4f} of that on the floor\n", all[1] / all[0],
               floor[1] / floor[0]);
    EXPECT_NEAR(all[1] / all[0], 1, 0.01);
    EXPECT_NEAR(floor[1] / floor[0], 1, 0.03);
}

/// The density of a point light's paths on a plane, and behind a mirror, is that of its rays.
TEST(LightPathsAnalytic, PathDensity)
{
    Scene scene;
    int const floor = add_material(scene, lambert(vec3{0.5f})), glass = add_material(scene, mirror(vec3{1}));
    add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, floor);
    add_quad(scene, {-0.2f, 2, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, glass); // reflects down
    add_light(scene, punctual(LightType::point, {0, 1, 0}));
    World const world = world_of(scene);
    constexpr std::uint32_t kPaths = 1 << 18;
    double direct = 0, mirrored = 0, light = 0, image = 0;
    for (LightVertex const& v : trace(Way::rays, world, paths_of(kPaths, 1))) {
        EXPECT_EQ(v.scatterings, 0);
        double const r2 = double(v.position.x * v.position.x + v.position.z * v.position.z),
                     d = v.by_delta ? 3 : 1;
        double const area = 4 * double(kPi) * std::pow(d * d + r2, 1.5) / (d * kPaths);
        EXPECT_NEAR(double(v.footprint), area, 2e-3 * area);
        // As many photons as their footprints fit into a disk, and a square.
        if (!v.by_delta && r2 < 0.25) {
            direct += double(v.footprint);
            light += 1;
        }
        if (v.by_delta) {
            mirrored += double(v.footprint);
            image += 1;
        }
    }
    EXPECT_NEAR(direct, double(kPi) * 0.25, 0.01);
    EXPECT_NEAR(mirrored, 0.6 * 2 * 0.6 * 2, 0.06);
    EXPECT_GT(light, 1000);
    EXPECT_GT(image, 400);
}

/// Texels of bounce maps have the density of their own solid angle: their footprints on a part of a plane add up
/// to its area, for a point light and for a one-sided lamp.
TEST(LightPathsAnalytic, PathDensityOfBounceMaps)
{
    for (bool const lamp : {false, true}) {
        Scene scene;
        add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, lambert(vec3{0.5f})));
        if (lamp) {
            add_quad(scene, {0, 1, 0}, {1e-3f, 0, 0}, {0, 0, 1e-3f}, add_material(scene, emitter(vec3{1})));
            scene.meshes.back().triangles.resize(1);
        } else {
            add_light(scene, punctual(LightType::point, {0, 1, 0}));
        }
        World const world = world_of(scene);
        double area = 0;
        for (LightVertex const& v : trace(Way::maps, world, paths_of(1 << 18, 1)))
            if (glm::length(vec2{v.position.x, v.position.z}) < 0.5f && v.normal.y > 0.5f)
                area += double(v.footprint);
        fmt::print("{}: footprints cover {:.4f} of the disk\n", lamp ? "lamp" : "point",
                   area / (double(kPi) * 0.25));
        EXPECT_NEAR(area / (double(kPi) * 0.25), 1, 0.01) << lamp;
    }
}

/// With a focus, half of the paths of a parallel light are spread over its sphere's disk, the others over the
/// whole one: footprints on a part of a plane still add up to its area, by rays and by bounce maps.
TEST(LightPathsAnalytic, PathDensityWithFocus)
{
    Scene scene;
    add_quad(scene, {-100, 0, -100}, {0, 0, 200}, {200, 0, 0}, add_material(scene, lambert(vec3{0.5f})));
    Light sun = punctual(LightType::directional, {});
    sun.direction = {0, -1, 0};
    add_light(scene, sun);
    World const world = world_of(scene);
    for (Way const way : {Way::rays, Way::maps}) {
        LightPaths s = paths_of(1 << 18, 1);
        s.focus = {{-1, 0, -1}, {1, 1, 1}};
        double in = 0, out = 0, flux_in = 0, flux_out = 0;
        std::size_t paths = 0;
        for (LightVertex const& v : trace(way, world, s)) {
            float const r = glm::length(vec2{v.position.x, v.position.z});
            if (r < 1) {
                in += double(v.footprint);
                flux_in += double(v.power.x) / 2;
                ++paths;
            }
            if (r > 20 && r < 80) {
                out += double(v.footprint);
                flux_out += double(v.power.x) / 2;
            }
        }
        double const disk = double(kPi), ring = double(kPi) * (80 * 80 - 20 * 20);
        fmt::print(
            "{}: footprints cover {:.4f} of a disk in the focus, which gets {:.4f} of its light by {} paths; "
            "{:.4f} and {:.4f} of a ring beside it\n",
            name(way), in / disk, flux_in / disk, paths, out / ring, flux_out / ring);
        EXPECT_NEAR(in / disk, 1, 0.02);
        EXPECT_NEAR(out / ring, 1, 0.02);
        EXPECT_NEAR(flux_in / disk, 1, 0.02);
        EXPECT_NEAR(flux_out / ring, 1, 0.02);
        EXPECT_GT(paths, s.count / 8);
    }
}

/// With a focus, the sky's light is the same by bounce maps as by rays:
/// on a floor under a half open roof, the focus below.
TEST(LightPathsAnalytic, SkyWithFocus)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    add_quad(scene, {-40, 0, -40}, {0, 0, 80}, {80, 0, 0}, matt);
    add_quad(scene, {-1, 1, -1}, {1, 0, 0}, {0, 0, 2}, matt);
    set_environment(scene, vec3{1});
    World const world = world_of(scene);
    auto const flux = [&](Way way, Bounds const& focus) {
        constexpr std::uint32_t kSets = 32;
        double near = 0, far = 0;
        for (std::uint32_t set = 0; set < kSets; ++set) {
            LightPaths s = paths_of(1 << 16, 1, set);
            s.focus = focus;
            for (LightVertex const& v : trace(way, world, s)) {
                bool const on_floor = v.position.y < 0.1f && v.normal.y > 0;
                if (on_floor && glm::length(v.position) < 0.8f) near += double(v.power.x) / kSets;
                if (on_floor && glm::length(v.position) > 10) far += double(v.power.x) / kSets;
            }
        }
        return glm::dvec2{near, far};
    };
    Bounds const focus{{-1, 0, -1}, {1, 1, 1}};
    glm::dvec2 const truth = flux(Way::rays, focus), found = flux(Way::maps, focus);
    fmt::print("sky by bounce maps with a focus: {:.4f} of that of rays in it, {:.4f} beside it\n",
               found.x / truth.x, found.y / truth.y);
    EXPECT_NEAR(found.x / truth.x, 1, 0.05);
    EXPECT_NEAR(found.y / truth.y, 1, 0.05);
}

/// Remembers what is asked.
struct ListeningRays : PathRays {
    ExactPathRays exact;
    mutable std::vector<PathQuery> asked;

    explicit ListeningRays(ExactVisibility const& visibility) : exact(visibility) {}
    void nearest(std::span<PathQuery> queries, std::span<Hit> hits) const override
    {
        asked.insert(asked.end(), queries.begin(), queries.end());
        exact.nearest(queries, hits);
    }
};

/// Light that leaves by a broad lobe may follow a stored direction, by a narrow lobe not.
TEST(LightPathsAnalytic, NarrowLobesKeepTheirDirection)
{
    Scene scene;
    Material polished = lambert(vec3{0.9f});
    polished.metallic = 1;
    polished.roughness = 0.2f;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.8f})), true);
    add_box(scene, {-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, add_material(scene, polished), false);
    add_light(scene, punctual(LightType::point, {0.1f, 0.8f, 0.2f}));
    World const world = world_of(scene);
    ExactVisibility const visibility(world, false, 1);
    ListeningRays const rays(visibility);
    PathCounts counts;
    tbb::task_arena(1).execute(
        [&] { trace_light_paths(view(world), world.bounds, rays, paths_of(20000, 4), counts); });
    int narrow = 0, again = 0, broad = 0;
    for (PathQuery const& q : rays.asked) {
        if (q.triangle == kNoTriangle) continue;
        if (world.triangle_material[q.triangle] == 1) {
            ++(q.any_direction ? again : narrow);
        } else {
            ++broad;
            ASSERT_TRUE(q.any_direction);
        }
    }
    EXPECT_GT(narrow, 1000);
    EXPECT_LT(again, narrow / 50) << "what facets of metal reflect more than once";
    EXPECT_GT(broad, 1000);
}

/// How the path of each texel continues: by a mirror, glass, a matt surface, or not at all.
TEST(LightPathsAnalytic, BounceMap)
{
    Scene scene;
    int const materials[] = {add_material(scene, lambert(vec3{1})), add_material(scene, mirror(vec3{1})),
                             add_material(scene, glass(1.5f, false)), add_material(scene, lambert(vec3{0}))};
    for (int k = 0; k < 4; ++k) // quarters of a floor, facing +Y
        add_quad(scene, {float(k % 2) - 1, 0, float(k / 2)}, {1, 0, 0}, {0, 0, -1}, materials[k]);
    add_light(scene, punctual(LightType::point, {0, 1, 0}));
    World const world = world_of(scene);
    LightPaths const s = paths_of(1 << 16, 3);
    std::array<std::array<int, 4>, 4> kinds{};
    for (LightView const& v : light_views(view(world), world.bounds, s, 4)) {
        std::vector<NearestTexel> const seen =
            draw_light_view(view(world), make_soup(world), v, CutOuts(world), 1);
        std::size_t const n = seen.size();
        std::vector<BounceTexel> texels(n);
        std::vector<LightPath> paths(n);
        std::vector<LightVertex> vertices(n);
        std::vector<std::uint8_t> has_vertex(n);
        launch_host(
            n,
            BounceTexels{
                view(world), v, {s.count, 0, 0}, {s.bounces, false}, seen, texels, paths, vertices, has_vertex});
        for (std::size_t k = 0; k < n; ++k) {
            BounceTexel const& t = texels[k];
            if (t.triangle == kNoTriangle) continue;
            std::size_t const quarter = t.triangle / 2;
            ++kinds[quarter][std::size_t(t.bounce)];
            vec3 const arrives =
                glm::normalize(v.face.direction(std::uint32_t(k) % v.width(), std::uint32_t(k) / v.width()));
            EXPECT_NEAR(t.depth, 1 / -arrives.y, 1e-3f * t.depth);
            if (t.bounce == Bounce::mirrored && quarter == 1) {
                EXPECT_LT(glm::length(t.direction - glm::reflect(arrives, vec3{0, 1, 0})), 1e-4f);
            }
            if (t.bounce == Bounce::transmitted) {
                EXPECT_NEAR(t.direction.x * t.direction.x + t.direction.z * t.direction.z,
                            (arrives.x * arrives.x + arrives.z * arrives.z) / (t.ior * t.ior), 1e-4f);
            }
            if (t.bounce == Bounce::scattered) {
                EXPECT_GT(t.direction.y, 0);
                EXPECT_GT(t.path_density, 0);
            }
            if (t.bounce != Bounce::none) {
                EXPECT_GT(max_component(t.power), 0);
            }
        }
    }
    auto const count = [&](std::size_t quarter, Bounce b) { return kinds[quarter][std::size_t(b)]; };
    EXPECT_GT(count(0, Bounce::scattered), 1000);
    EXPECT_EQ(count(0, Bounce::mirrored) + count(0, Bounce::transmitted), 0);
    EXPECT_GT(count(1, Bounce::mirrored), 1000);
    EXPECT_EQ(count(1, Bounce::scattered) + count(1, Bounce::transmitted), 0);
    EXPECT_GT(count(2, Bounce::transmitted), 1000);
    EXPECT_GT(count(2, Bounce::mirrored), 10);
    EXPECT_EQ(count(2, Bounce::scattered), 0);
    EXPECT_GT(count(3, Bounce::none), 1000);
    EXPECT_EQ(count(3, Bounce::scattered), 0);
}

TEST(LightPathsAnalytic, NothingToTrace)
{
    Scene scene;
    World const empty = world_of(scene);
    for (Way const way : {Way::rays, Way::maps}) EXPECT_TRUE(trace(way, empty, paths_of(100, 3)).empty());
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, add_material(scene, lambert(vec3{1})));
    World const dark = world_of(scene);
    for (Way const way : {Way::rays, Way::maps}) EXPECT_TRUE(trace(way, dark, paths_of(100, 3)).empty());
    add_light(scene, punctual(LightType::point, {5, -1, 5})); // sees the back of the only surface
    World const lit = world_of(scene);
    for (Way const way : {Way::rays, Way::maps})
        for (LightVertex const& v : trace(way, lit, paths_of(1, 3))) EXPECT_TRUE(all_finite(v.power));
}

} // namespace
} // namespace gi::test
