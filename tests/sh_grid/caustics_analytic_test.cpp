// Light by way of mirrors and glass in the method sh_grid: closed forms, and pictures of the reference.

#include "gi/methods/reference/reference.h"
#include "gi/light_paths/caustics.h"
#include "gi/methods/sh_grid/field_rays.h"
#include "gi/methods/sh_grid/sh_grid.h"
#include "gi/methods/whitted/settings.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

RenderSettings caustic_settings(int size, std::uint32_t paths, int voxels)
{
    RenderSettings s;
    s.width = s.height = size;
    s.paths = paths;
    s.of<ShGridSettings>().voxels = voxels;
    return s;
}

/// Mean over a part of the picture, in pixels, of a layer's red channel.
double mean_in(Picture const& p, std::string const& layer, glm::ivec2 low, glm::ivec2 high, int width)
{
    double sum = 0;
    for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x) sum += double(rgb(*p.find(layer), std::size_t(y * width + x)).x);
    return sum / double((high.x - low.x) * (high.y - low.y));
}

/// A sun, a mirror at 45 degrees beside a wall: the spot has the sun's irradiance times cosine and reflectance.
TEST(ShGridCaustics, SunOverAMirrorOnAWall)
{
    constexpr float kReflectance = 0.8f, kAlbedo = 0.5f;
    Scene scene;
    // Seen from +z, the wall is z = 0. The sun shines along -y on a mirror that sends it to -z.
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(scene, lambert(vec3{kAlbedo})));
    add_quad(scene, {-0.5f, -0.5f, 1}, {1, 0, 0}, {0, 1, 1}, add_material(scene, mirror(vec3{kReflectance})));
    Light sun;
    sun.type = LightType::directional;
    sun.direction = {0, -1, 0};
    sun.intensity = vec3{2};
    add_light(scene, sun);
    constexpr int kSize = 32;
    RenderSettings s = caustic_settings(kSize, 16, 32);
    // The mirror spans y from -0.5 to 0.5; the camera looks from beside, beneath it.
    Report report;
    Camera const eye = orthographic({0, 0, 0.5}, {0, 0, 0}, 0.6);
    Picture const p = render_sh_grid(world_of(scene), eye, s, {}, {}, report).picture;
    double const truth = 2 * kReflectance * kAlbedo / kPiD; // at right angles to the wall
    double const seen = mean_in(p, "L1", {0, 0}, {kSize, kSize}, kSize);
    fmt::print("spot over the closed form: {:.4f}\n", seen / truth);
    EXPECT_NEAR(seen / truth, 1, 0.02);
    EXPECT_NEAR(report.counts().at("caustic photons: flux, W (luminance)"), 2 * kReflectance, 0.02);
    // Without, it is dark, but for rounding: the sun grazes the wall.
    s.of<PhotonSettings>().caustic_paths = 0;
    EXPECT_LT(mean_of(render_sh_grid(world_of(scene), eye, s, {}, {}, report).picture, "L1").mean, 1e-9);
}

/// A pane over a floor dims the sun by its reflectance, once.
TEST(ShGridCaustics, APaneLetsTheSunIn)
{
    Scene scene;
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, lambert(vec3{0.5f})));
    add_quad(scene, {-2, 1, -2}, {0, 0, 4}, {4, 0, 0}, add_material(scene, glass(1.5f, true)));
    Light sun;
    sun.type = LightType::directional;
    sun.direction = {0, -1, 0};
    sun.intensity = vec3{1};
    add_light(scene, sun);
    constexpr int kSize = 32;
    Report report;
    Camera eye = look_at({0, 0.9, 0}, {0, 0, 0.01}, 40);
    Picture const p =
        render_sh_grid(world_of(scene), eye, caustic_settings(kSize, 16, 32), {}, {}, report).picture;
    double const face = 0.04, truth = 0.5 / kPiD * (1 - 2 * face / (1 + face));
    double const seen = mean_in(p, "L1", {0, 0}, {kSize, kSize}, kSize);
    fmt::print("below a pane over the closed form: {:.4f}\n", seen / truth);
    EXPECT_NEAR(seen / truth, 1, 0.02);
}

/// A sun that falls by a mirror past an edge at x = 0: the edge gets sharper with more passes.
TEST(ShGridCaustics, EdgesGetSharper)
{
    Scene scene;
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(scene, lambert(vec3{1})));
    add_quad(scene, {-1, -1, 1}, {1, 0, 0}, {0, 2, 2}, add_material(scene, mirror(vec3{1})));
    Light sun;
    sun.type = LightType::directional;
    sun.direction = {0, -1, 0};
    sun.intensity = vec3{kPi};
    add_light(scene, sun);
    World const world = world_of(scene);
    constexpr int kSize = 32;
    double off[2] = {0, 0};
    for (int k = 0; k < 2; ++k) {
        Report report;
        RenderSettings s = caustic_settings(kSize, k == 0 ? 4 : 64, 32);
        s.of<PhotonSettings>().caustic_paths = 16384;
        Picture const p =
            render_sh_grid(world, orthographic({0, 0, 0.5}, {0, 0, 0}, 0.6), s, {}, {}, report).picture;
        for (int x = 0; x < kSize; ++x) // the mean of a column hides the noise
            off[k] += std::abs(mean_in(p, "L1", {x, 0}, {x + 1, kSize}, kSize) - (x < kSize / 2 ? 1 : 0)) / kSize;
    }
    fmt::print("off by {:.4f} after 4 passes, {:.4f} after 64\n", off[0], off[1]);
    EXPECT_LT(off[1], 0.75 * off[0]);
}

/// Inside of a box that glows evenly, of which a wall is a perfect mirror, light of one scattering is the albedo,
/// and that of more albedo^2 / (1 - albedo): a half and a half.
TEST(ShGridCaustics, FurnaceWithAMirrorWall)
{
    Scene scene;
    Material glow = emitter(vec3{1}, true);
    glow.base_color = vec3{0.5f};
    int const wall = add_material(scene, glow);
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, wall, true);
    add_quad(scene, {-1, -1, -0.6f}, {2, 0, 0}, {0, 2, 0}, add_material(scene, mirror(vec3{1}))); // before a wall
    for (int const photons : {0, 65536}) {
        Report report;
        RenderSettings s = caustic_settings(32, 8, 64);
        s.of<PhotonSettings>().caustic_paths = photons;
        Picture const p =
            render_sh_grid(world_of(scene), look_at({0, 0, 0}, {0, 0, 1}, 80), s, {}, {}, report).picture;
        double const once = 2 * mean_of(p, "L1").mean, more = 2 * mean_of(p, "L2").mean;
        fmt::print("{} photons: one scattering {:.4f}, more {:.4f}\n", photons, once, more);
        EXPECT_NEAR(more, 1, 0.01);
        if (photons == 0) continue;
        EXPECT_NEAR(once, 1, 0.02);
    }
}

/// A box with a lamp. @param smooth  a sphere and a wall of this
World box_with_sphere(Material const& smooth)
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.6f})), true);
    add_quad(scene, {-0.5f, 0.98f, -0.5f}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(vec3{3}, false)));
    int const material = add_material(scene, smooth);
    add_sphere(scene, {0, -0.3f, 0}, 0.4f, 4, material, true);
    return world_of(scene);
}

/// The light of surfaces under a sphere of glass or metal is that of the reference.
TEST(ShGridCaustics, EnergyOfTheReference)
{
    Camera const eye = look_at({0, 0.3, 0.95}, {0, -0.9, -0.2}, 80);
    for (bool const metal : {false, true}) {
        World const world = box_with_sphere(metal ? mirror(vec3{0.9f}) : glass(1.5f, false));
        Report report;
        RenderSettings s = caustic_settings(16, 200, 64);
        s.threads = 0;
        Picture const paths = render_reference(world, eye, s, {}, {}, report).picture;
        s.paths = 8;
        s.of<WhittedSettings>().recursion = 16;
        s.of<PhotonSettings>().caustic_paths = 65536;
        Picture const trees = render_sh_grid(world, eye, s, {}, {}, report).picture;
        double const l1 = mean_of(trees, "L1").mean / mean_of(paths, "L1").mean,
                     l2 = mean_of(trees, "L2").mean / mean_of(paths, "L2").mean;
        fmt::print("{}: direct light and caustics {:.4f}, indirect light {:.4f} of the reference\n",
                   metal ? "metal" : "glass", l1, l2);
        EXPECT_NEAR(l1, 1, 0.03);
        EXPECT_NEAR(l2, 1, 0.05);
    }
}

/// At rest the disks shrink from pass to pass; a camera that moves gets the first photons again.
TEST(ShGridCaustics, PhotonsStayWhileTheCameraMoves)
{
    World const world = box_with_sphere(glass(1.5f, false));
    ExactVisibility const visibility(world, false, 0);
    RenderSettings const s = caustic_settings(16, 1, 32);
    Report report;
    Caustics caustics(world, s, report);
    PathCounts counts;
    std::uint32_t index = 0;
    auto const pass = [&](double x) {
        FrameView const view{look_at({x, 0.3, 0.95}, {0, -0.9, -0.2}, 80), 16, 16};
        caustics.prepare(visibility, index++, {&view, 1}, {}, 1, BuildStop(nullptr), counts);
        return caustics.map();
    };
    float const first = pass(0)->mean_radius();
    dvec3 const flux = caustics.map()->flux();
    EXPECT_GT(first, 0);
    EXPECT_NEAR(pass(0)->mean_radius() / first, std::sqrt((1 + 2.0 / 3) / 2), 0.03);
    EXPECT_NEAR(pass(0)->mean_radius() / first, std::sqrt((1 + 2.0 / 3) / 2 * (2 + 2.0 / 3) / 3), 0.03);
    EXPECT_NE(caustics.map()->flux(), flux);
    for (double const x : {0.1, 0.2, 0.3}) {
        EXPECT_EQ(pass(x)->mean_radius(), first);
        EXPECT_EQ(caustics.map()->flux(), flux);
    }
    EXPECT_LT(pass(0.3)->mean_radius(), first);
    Changes turned;
    turned.cameras = true;
    caustics.changed(turned);
    EXPECT_LT(pass(0.3)->mean_radius(), first);
    Changes lights;
    lights.lights = true;
    caustics.changed(lights);
    EXPECT_EQ(pass(0.3)->mean_radius(), first);
}

/// Tints keep 7 bits or more of their largest channel, and 1 exactly.
TEST(ShGridCaustics, PackedTints)
{
    EXPECT_EQ(packed(vec3{1}).unpacked(), vec3{1});
    EXPECT_EQ(PackedTint{}.unpacked(), vec3{1});
    EXPECT_EQ(packed(vec3{0}).unpacked(), vec3{0});
    for (float const scale : {1e-20f, 1e-3f, 0.9999f, 2.25f, 1e20f}) {
        vec3 const tint = scale * vec3{0.2f, 0.9f, 0.5f}, off = packed(tint).unpacked() - tint;
        EXPECT_LE(max_component(glm::abs(off)), scale / 254);
    }
}

/// Without mirrors and glass there is nothing to trace.
TEST(ShGridCaustics, NothingSmoothCostsNothing)
{
    Report report;
    World const world = box_with_sphere(lambert(vec3{0.5f}));
    EXPECT_TRUE(find_caustic_targets(world, {}).choice.empty());
    Camera const eye = look_at({0, 0.3, 0.95}, {0, -0.9, -0.2}, 80);
    RenderSettings s = caustic_settings(16, 2, 32);
    Picture const with = render_sh_grid(world, eye, s, {}, {}, report).picture;
    for (auto const& [stage, seconds] : report.times()) EXPECT_NE(stage, "caustic photons");
    s.of<PhotonSettings>().caustic_paths = 0;
    EXPECT_EQ(with.find("color")->data, render_sh_grid(world, eye, s, {}, {}, report).picture.find("color")->data);
}

/// A lamp with a focus elsewhere: both groups of triangles get paths, and the chances add up to 1.
TEST(ShGridCaustics, HalfOfThePathsGoToTheFocus)
{
    Scene scene;
    int const smooth = add_material(scene, mirror(vec3{0.9f}));
    add_sphere(scene, {0, 0, 0}, 0.01f, 1, smooth, false);
    add_box(scene, {-100, -100, -100}, {100, 100, 100}, smooth, true);
    set_environment(scene, vec3{1});
    World const world = world_of(scene);
    Bounds const focus{vec3{-1}, vec3{1}};
    StartTargets const targets = find_caustic_targets(world, focus);
    double in_focus = 0, all = 0;
    for (std::size_t k = 0; k < targets.triangles.size(); ++k) {
        double const chance = double(targets.choice.entries[k].probability);
        all += chance;
        if (glm::length(world.surfaces[targets.triangles[k]].corner) < 1) in_focus += chance;
    }
    EXPECT_NEAR(all, 1, 1e-5);
    EXPECT_NEAR(in_focus, 0.5, 1e-5);
}

} // namespace
} // namespace gi::test
