// Pictures of the method sh_grid against closed forms and quadrature: furnaces, form factors, flux, leaks, scales.

#include "gi/methods/reference/reference.h"
#include "gi/methods/sh_grid/settings.h"
#include "gi/methods/sh_grid/sh_grid.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/motion/moving_world.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

RenderSettings picture_of(int size, int voxels)
{
    RenderSettings s;
    s.width = s.height = size;
    s.paths = 4;
    s.of<ShGridSettings>().voxels = voxels;
    return s;
}

Material glowing(float radiance, float albedo)
{
    Material m = emitter(vec3{radiance}, true);
    m.base_color = vec3{albedo};
    return m;
}

void transform(Scene& scene, glm::mat3 const& by)
{
    for (Mesh& mesh : scene.meshes)
        for (vec3& p : mesh.positions) p = by * p;
}

glm::mat3 const kTurn{{0.8f, 0.36f, 0.48f}, {-0.6f, 0.48f, 0.64f}, {0, -0.8f, 0.6f}};

enum class Shape { box, turned_box, sphere };

/// Inside of something closed that glows evenly, light of two and more scatterings is albedo^2 / (1 - albedo):
/// with an albedo of a half, a half.
TEST(ShGrid, Furnace)
{
    for (Shape const shape : {Shape::box, Shape::turned_box, Shape::sphere})
        for (int const voxels : {32, 128})
            for (RadianceBy const by : {RadianceBy::normal, RadianceBy::direction}) {
                if (voxels == 128 && shape != Shape::turned_box) continue; // takes long
                Scene scene;
                int const wall = add_material(scene, glowing(1, 0.5f));
                if (shape == Shape::sphere)
                    add_sphere(scene, vec3{0}, 1, 5, wall, false);
                else
                    add_box(scene, {-1, -1, -1}, {1, 1, 1}, wall, true);
                if (shape == Shape::turned_box) transform(scene, kTurn);
                Report report;
                RenderSettings s = picture_of(32, voxels);
                s.of<ShGridSettings>().radiance_by = by;
                Picture const p =
                    render_sh_grid(world_of(scene), look_at({0, 0, 0.3}, {0, -0.2, -1}, 90), s, {}, {}, report)
                        .picture;
                double mean = 0, off = 0;
                for (float const v : p.find("L2")->data) {
                    mean += 2 * double(v) / double(p.find("L2")->data.size());
                    off += std::abs(2 * double(v) - 1) / double(p.find("L2")->data.size());
                }
                fmt::print("shape {} of {} voxels, by {}: mean {:.4f}, off by {:.4f}\n", int(shape), voxels,
                           by == RadianceBy::normal ? "normal" : "direction", mean, off);
                EXPECT_NEAR(mean, 1, 0.03);
                if (by == RadianceBy::normal) {
                    EXPECT_NEAR(mean, 1, 0.005);
                    EXPECT_LT(off, 0.008);
                }
                // The grid holds all the power of the photons, which is that emitted and reflected by the walls.
                auto const& counts = report.counts();
                double const carried = counts.at("flux of the photons, W (luminance)");
                EXPECT_NEAR(counts.at("grid: flux held, W (luminance)") / carried, 1, 1e-4);
                double const area = shape == Shape::sphere ? 4 * kPiD : 24; // that of a mesh is a little less
                EXPECT_NEAR(carried / (area * kPiD), 1, 0.01);
            }
}

/// A floor in parallel light lights a wall at a right angle to it. Returns the mean relative difference from
/// quadrature, away from the wall's edges.
double off_at_wall(int voxels, int degree)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.8f}));
    add_quad(scene, {-1, 0, 0}, {0, 0, 2}, {2, 0, 0}, matt); // y = 0, facing up
    add_quad(scene, {-1, 0, 0}, {2, 0, 0}, {0, 2, 0}, matt); // z = 0, facing +z
    Light sun;
    sun.type = LightType::directional;
    sun.direction = {0, -1, 0};
    sun.intensity = vec3{1};
    add_light(scene, sun);
    RenderSettings s = picture_of(24, voxels);
    s.bounces = 1;
    s.of<ShGridSettings>().degree = degree;
    s.paths = 32;
    Report report;
    Picture const p =
        render_sh_grid(world_of(scene), orthographic({0, 1, 5}, {0, 1, 0}, 2), s, {}, {}, report).picture;
    double off = 0;
    int n = 0;
    for (int y = 3; y < 21; ++y)
        for (int x = 3; x < 21; ++x) {
            dvec3 const at{-1 + (x + 0.5) / 12, 2 - (y + 0.5) / 12, 0};
            constexpr int kParts = 200;
            double irradiance = 0; // the floor's radiance is 0.8 / pi
            for (int i = 0; i < kParts; ++i)
                for (int k = 0; k < kParts; ++k) {
                    dvec3 const way = dvec3{-1 + (i + 0.5) * 2 / kParts, 0, (k + 0.5) * 2 / kParts} - at;
                    double const r2 = glm::dot(way, way);
                    irradiance += 0.8 / kPiD * way.z * -way.y / (r2 * r2) * (4.0 / (kParts * kParts));
                }
            double const truth = 0.8 / kPiD * irradiance;
            off += std::abs(double(rgb(*p.find("L2"), std::size_t(y * 24 + x)).x) / truth - 1);
            ++n;
        }
    return off / n;
}

TEST(ShGrid, FormFactorOfAFloorAtAWall)
{
    double last = 1;
    for (int const voxels : {32, 64, 128}) {
        double const off = off_at_wall(voxels, 2);
        fmt::print("{} voxels: {:.4f}, order {:.2f}\n", voxels, off, std::log2(last / off));
        last = off;
    }
    EXPECT_LT(last, 0.05);
    fmt::print("degree 4: {:.4f}\n", off_at_wall(128, 4));
}

/// Two rooms with a wall between them that is a hundredth of a cell thick. Returns the light in the dark one over
/// that in the lit one.
double leak(Switch weights, int rays)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.7f}));
    add_box(scene, {-2, -1, -1}, {-0.001f, 1, 1}, matt, true);
    add_box(scene, {0.001f, -1, -1}, {2, 1, 1}, matt, true);
    Light lamp;
    lamp.type = LightType::point;
    lamp.position = {-1, 0.2f, 0.1f};
    add_light(scene, lamp);
    World const world = world_of(scene);
    RenderSettings s = picture_of(32, 64);
    s.of<ShGridSettings>().leak_weights = weights;
    s.of<ShGridSettings>().field_shadow_rays = rays;
    Report report;
    auto const light = [&](double x, double towards) {
        Picture const p =
            render_sh_grid(world, look_at({x, 0, 0}, {towards, 0.1, 0.05}, 100), s, {}, {}, report).picture;
        return mean_of(p, "L2").mean;
    };
    return light(1.5, 0) / light(-1.5, 0);
}

TEST(ShGrid, ThinWallsDoNotLeak)
{
    double const paper = leak(Switch::off, 0), weights = leak(Switch::on, 0), rays = leak(Switch::on, 4);
    fmt::print("light in the dark room: as in the paper {:.4f}, with weights {:.2g}, with rays {:.2g}\n", paper,
               weights, rays);
    EXPECT_GT(paper, 0.02);
    EXPECT_LT(weights, 0.3 * paper);
    EXPECT_LT(rays, 1e-6);
}

TEST(ShGrid, AnyScale)
{
    double expected = 0;
    for (float const scale : {1.0f, 1e-3f, 1e5f}) {
        Scene scene = generate_cornell();
        transform(scene, glm::mat3(scale));
        for (Node& node : scene.nodes) node.translation *= scale;
        Camera eye =
            look_at(dvec3{0.278, 0.273, -0.8} * double(scale), dvec3{0.278, 0.273, 0} * double(scale), 39);
        Report report;
        Picture const p = render_sh_grid(world_of(scene), eye, picture_of(24, 64), {}, {}, report).picture;
        double const mean = mean_of(p, "L2").mean;
        EXPECT_GT(mean, 0);
        if (expected == 0) expected = mean;
        EXPECT_NEAR(mean / expected, 1, 0.02) << scale;
    }
}

/// The convolution in closed form is the limit of many samples.
TEST(ShGrid, ClosedFormIsTheLimitOfSamples)
{
    World const world = world_of(generate_cornell());
    Camera const eye = world.cameras.at(0);
    Report report;
    RenderSettings s = picture_of(24, 64);
    double const closed = mean_of(render_sh_grid(world, eye, s, {}, {}, report).picture, "L2").mean;
    s.of<ShGridSettings>().gather_directions = 32;
    double const sampled = mean_of(render_sh_grid(world, eye, s, {}, {}, report).picture, "L2").mean;
    fmt::print("closed form over 32 samples: {:.4f}\n", closed / sampled);
    EXPECT_NEAR(closed / sampled, 1, 0.03);
}

/// When lights go out, the field follows within three frames. A moving camera does not restart it.
TEST(ShGrid, FollowsLights)
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.7f})), true);
    Light lamp;
    lamp.type = LightType::point;
    lamp.position = {0.1f, 0.2f, 0.1f};
    add_light(scene, lamp);
    Report report;
    MovingWorld moving(std::make_shared<Scene const>(scene), 0.0, report);
    Camera const eye = look_at({0, 0, 0.9}, {0, 0, -1}, 80);
    RenderSettings s = picture_of(16, 32);
    s.paths = 1;
    auto const frames = start_sh_grid_frames(moving, eye, s, report);
    double const lit = mean_of(frames->frame(eye, {}, {}, {}).picture, "L2").mean;
    EXPECT_GT(lit, 0);
    Changes turned;
    turned.cameras = true;
    frames->changed(turned);
    EXPECT_NEAR(mean_of(frames->frame(eye, {}, {}, {}).picture, "L2").mean / lit, 1, 0.02);
    Light half = moving.world().lights.at(0);
    half.intensity = vec3{0.5f};
    frames->changed(moving.set_light(0, half));
    double now = 0;
    for (int k = 0; k < 3; ++k) now = mean_of(frames->frame(eye, {}, {}, {}).picture, "L2").mean;
    EXPECT_NEAR(now / lit, 0.5, 0.02);
    half.intensity = vec3{0};
    frames->changed(moving.set_light(0, half));
    for (int k = 0; k < 3; ++k) now = mean_of(frames->frame(eye, {}, {}, {}).picture, "L2").mean;
    EXPECT_EQ(now, 0);
}

/// A floor and a wall under a lamp, before a dark sky: what sees the sky is lit all the same.
TEST(ShGrid, OpenSceneUnderADarkSky)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.7f}));
    add_quad(scene, {-1.5f, 0, -1.5f}, {0, 0, 3}, {3, 0, 0}, matt);
    add_quad(scene, {-1.5f, 0, -1.5f}, {3, 0, 0}, {0, 2, 0}, matt);
    Light lamp;
    lamp.type = LightType::point;
    lamp.position = {0.1f, 1.4f, 0.2f};
    add_light(scene, lamp);
    World const world = world_of(scene);
    Camera const eye = look_at({0, 1, 4}, {0, 0.7, 0}, 50);
    RenderSettings s = picture_of(48, 64);
    s.paths = 16;
    Report report;
    double const own = mean_of(render_sh_grid(world, eye, s, {}, {}, report).picture, "L2").mean;
    s.paths = 512;
    double const truth = mean_of(render_reference(world, eye, s, {}, {}, report).picture, "L2").mean;
    fmt::print("open scene: {:.4f} of the reference\n", own / truth);
    EXPECT_NEAR(own / truth, 1, 0.06);
}

/// A room whose only light comes through a window, alone and on a plain of 400 m: the sky and what the plain
/// reflects light it alike.
TEST(ShGrid, RoomInALargeWorld)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.6f}));
    add_quad(scene, {-200, -0.1f, -200}, {0, 0, 400}, {400, 0, 0}, matt);
    for (float const shell : {0.0f, 0.2f}) { // inner and outer sides of walls with a window at x = 2
        vec3 const low{-2 - shell, -shell / 4, -2 - shell}, high{2 + shell, 2.5f + shell, 2 + shell};
        vec3 const e = high - low;
        add_quad(scene, low, {e.x, 0, 0}, {0, 0, e.z}, matt);
        add_quad(scene, {low.x, high.y, low.z}, {e.x, 0, 0}, {0, 0, e.z}, matt);
        for (float const z : {low.z, high.z}) add_quad(scene, {low.x, low.y, z}, {e.x, 0, 0}, {0, e.y, 0}, matt);
        add_quad(scene, low, {0, e.y, 0}, {0, 0, e.z}, matt);
        add_quad(scene, {high.x, low.y, low.z}, {0, 1 - low.y, 0}, {0, 0, e.z}, matt);
        add_quad(scene, {high.x, 2, low.z}, {0, high.y - 2, 0}, {0, 0, e.z}, matt);
        add_quad(scene, {high.x, 1, low.z}, {0, 1, 0}, {0, 0, -0.7f - low.z}, matt);
        add_quad(scene, {high.x, 1, 0.7f}, {0, 1, 0}, {0, 0, high.z - 0.7f}, matt);
    }
    set_environment(scene, vec3{1});
    World const world = world_of(scene);
    Camera const eye = look_at({1.5, 1.6, 1.5}, {-2, 0.8, -1}, 70);
    RenderSettings s = picture_of(32, 64);
    Report report;
    double const own = mean_of(render_sh_grid(world, eye, s, {}, {}, report).picture, "L2").mean;
    EXPECT_GT(report.counts().at("fine grid: cells of the field"), 100);
    s.paths = 1024;
    double const truth = mean_of(render_reference(world, eye, s, {}, {}, report).picture, "L2").mean;
    fmt::print("room on a plain: {:.4f} of the reference\n", own / truth);
    EXPECT_NEAR(own / truth, 1, 0.1);
}

/// A lit box moves away: its light leaves with it, and in the frames that follow all photons and cells know.
TEST(ShGrid, FollowsMotion)
{
    Scene scene;
    int const wall = add_material(scene, lambert(vec3{0.6f}));
    add_box(scene, {-2, -1, -1}, {2, 1, 1}, wall, true);
    Light lamp;
    lamp.type = LightType::point;
    lamp.position = {0, 0.8f, 0};
    add_light(scene, lamp);
    int const red = add_material(scene, lambert(vec3{0.9f, 0.1f, 0.1f}));
    std::size_t const box = scene.nodes.size();
    add_box(scene, {-0.5f, -0.6f, -0.3f}, {0.1f, 0.1f, 0.3f}, red, false);
    for (std::size_t k = box; k < scene.nodes.size(); ++k) scene.nodes[k].driven = true;
    Report report;
    auto const shared = std::make_shared<Scene const>(scene);
    MovingWorld moving(shared, 0.0, report);
    ASSERT_LT(moving.world().static_triangles, moving.world().triangles.size());
    Camera const eye = look_at({-1.9, 0, 0}, {0, -0.2, 0}, 80);
    RenderSettings s = picture_of(24, 64);
    s.paths = 1;
    auto const mean_now = [&](FrameRenderer& frames, int n) {
        Picture p;
        for (int k = 0; k < n; ++k) p = frames.frame(eye, {}, {}, {}).picture;
        return mean_of(p, "L2").mean;
    };
    auto const frames = start_sh_grid_frames(moving, eye, s, report);
    double const before = mean_now(*frames, 1);
    Pose pose = evaluate_pose(*shared, 0.0);
    for (std::size_t k = box; k < scene.nodes.size(); ++k)
        pose.world_from_node[k] = glm::translate(pose.world_from_node[k], dvec3{1.2, 0, 0});
    frames->changed(moving.advance(pose));
    int const parts = s.of<ShGridSettings>().field_passes;
    double const followed = mean_now(*frames, 2 * parts - 1);
    auto const fresh = start_sh_grid_frames(moving, eye, s, report);
    double const truth = mean_now(*fresh, 1);
    EXPECT_NEAR(followed / truth, 1, 0.01);
    EXPECT_GT(std::abs(before / truth - 1), 0.02) << "nothing to follow";
}

/// A grid as fine as the budget allows, and the picture's options say which.
TEST(ShGrid, BudgetLimitsTheGrid)
{
    World const world = world_of(generate_cornell());
    RenderSettings s = picture_of(16, 256);
    s.budget_s = 0.02;
    s.paths = 1u << 20;
    Report report;
    RenderResult const r = render_sh_grid(world, world.cameras.at(0), s, {}, {}, report);
    EXPECT_GT(mean_of(r.picture, "L2").mean, 0);
    EXPECT_EQ(r.options.find("--voxels 256"), std::string::npos) << r.options;
    EXPECT_NE(r.options.find("--voxels"), std::string::npos) << r.options;
}

/// A glyph shows the radiance that arrives from where its surface points: in a furnace all the same.
TEST(ShGrid, GlyphsShowTheField)
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, glowing(1, 0.5f)), true);
    RenderSettings s = picture_of(32, 32);
    s.of<ShGridSettings>().field_glyphs = Switch::on;
    Report report;
    Picture const p =
        render_sh_grid(world_of(scene), look_at({0, 0, 0.3}, {0, -0.2, -1}, 90), s, {}, {}, report).picture;
    std::size_t glyphs = 0;
    for (std::size_t i = 0; i < p.pixels(); ++i) {
        if (rgb(*p.find("L0"), i).x > 0) continue; // some path met the wall
        ++glyphs;
        EXPECT_NEAR(rgb(*p.find("L2"), i).x, 1, 0.03) << i; // reflected once or more: 1
    }
    EXPECT_GT(glyphs, 3u);
}

/// A floor with a narrow glossy lobe: its rays bring what it reflects, the lamp and the walls, once.
TEST(ShGrid, NarrowGlossyLobesGetRays)
{
    Scene scene;
    Material floor = lambert(vec3{0.4f});
    floor.specular = 1;
    floor.roughness = 0.35f;
    add_box(scene, {-1, -2, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.5f})), true);
    add_quad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, floor));
    add_quad(scene, {-0.3f, 0.5f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(vec3{4}, true)));
    World const world = world_of(scene);
    Camera const eye = look_at({0, 0, 0.9}, {0, -1, -0.6}, 60);
    RenderSettings s = picture_of(32, 64);
    s.paths = 48;
    Report report;
    Picture const own = render_sh_grid(world, eye, s, {}, {}, report).picture;
    s.paths = 512;
    Picture const truth = render_reference(world, eye, s, {}, {}, report).picture;
    for (char const* const layer : {"L1", "L2"}) {
        double const ratio = mean_of(own, layer).mean / mean_of(truth, layer).mean;
        fmt::print("glossy floor, {}: {:.4f} of the reference\n", layer, ratio);
        EXPECT_NEAR(ratio, 1, layer == std::string_view("L1") ? 0.01 : 0.05) << layer;
    }
}

/// Without indirect bounces there is none, whatever rays of glossy lobes meet.
TEST(ShGrid, NoBounces)
{
    Scene scene;
    Material floor = lambert(vec3{0.4f});
    floor.specular = 1;
    floor.roughness = 0.35f;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, floor), true);
    add_sphere(scene, {0.4f, -0.6f, 0}, 0.3f, 3, add_material(scene, mirror(vec3{0.9f})), true);
    Light lamp;
    lamp.type = LightType::point;
    lamp.position = {0, 0.5f, 0};
    add_light(scene, lamp);
    RenderSettings s = picture_of(16, 32);
    s.bounces = 0;
    Report report;
    Picture const p =
        render_sh_grid(world_of(scene), look_at({0, 0, 0.9}, {0, -0.5, -1}, 80), s, {}, {}, report).picture;
    EXPECT_GT(mean_of(p, "L1").mean, 0);
    EXPECT_EQ(mean_of(p, "L2").mean, 0);
}

/// Without light, without surfaces, and with only one triangle.
TEST(ShGrid, LittleOrNothing)
{
    Report report;
    Camera const eye = look_at({0, 0, 2}, {0, 0, 0}, 60);
    EXPECT_EQ(mean_of(render_sh_grid(world_of(Scene{}), eye, picture_of(4, 32), {}, {}, report).picture).mean, 0);
    Scene one;
    add_quad(one, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, add_material(one, lambert(vec3{0.5f})));
    EXPECT_EQ(mean_of(render_sh_grid(world_of(one), eye, picture_of(4, 32), {}, {}, report).picture).mean, 0);
    set_environment(one, vec3{1});
    double const lit = mean_of(render_sh_grid(world_of(one), eye, picture_of(8, 32), {}, {}, report).picture).mean;
    EXPECT_GT(lit, 0);
    EXPECT_TRUE(std::isfinite(lit));
}

/// A walk through the voxels finds what exact rays find, within the voxels' size.
TEST(ShGrid, VoxelsForExactRays)
{
    World const world = world_of(generate_cornell());
    Report report;
    RenderSettings s = picture_of(24, 128);
    double const exact = mean_of(render_sh_grid(world, world.cameras.at(0), s, {}, {}, report).picture, "L2").mean;
    s.of<ShGridSettings>().field_rays = FieldRays::voxels;
    double const voxels =
        mean_of(render_sh_grid(world, world.cameras.at(0), s, {}, {}, report).picture, "L2").mean;
    fmt::print("voxels over exact rays: {:.4f}\n", voxels / exact);
    EXPECT_NEAR(voxels / exact, 1, 0.1);
}

} // namespace
} // namespace gi::test
