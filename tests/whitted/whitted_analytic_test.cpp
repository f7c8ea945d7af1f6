// Ray trees: what is seen directly and direct light are those of the reference,
// and mirrors and glass obey closed forms.

#include "gi/methods/reference/reference.h"
#include "gi/methods/whitted/whitted.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/motion/moving_world.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

RenderSettings picture_of(int size, std::uint32_t paths)
{
    RenderSettings s;
    s.width = s.height = size;
    s.paths = paths;
    s.threads = 1;
    return s;
}

/// A room with a lamp and a point light. @param smooth  with a mirror, solid and thin glass; else with matt things
World room(bool smooth)
{
    Scene scene;
    int const wall = add_material(scene, lambert(vec3{0.5f}));
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, wall, true);
    add_quad(scene, {-0.4f, 0.99f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f},
             add_material(scene, emitter(vec3{3}, true)));
    add_sphere(scene, {-0.5f, -0.4f, -0.3f}, 0.3f, 4,
               add_material(scene, smooth ? mirror(vec3{0.9f}) : lambert(vec3{0.9f})), true);
    add_sphere(scene, {0.4f, -0.5f, -0.2f}, 0.3f, 4,
               add_material(scene, smooth ? glass(1.5f, false) : lambert(vec3{0.2f})), true);
    if (smooth)
        add_quad(scene, {-0.2f, -0.9f, 0.2f}, {0.4f, 0, 0}, {0, 0.6f, 0}, add_material(scene, glass(1.5f, true)));
    Light point;
    point.type = LightType::point;
    point.position = {0.6f, 0.5f, 0.6f};
    point.intensity = vec3{0.2f};
    add_light(scene, point);
    return world_of(scene);
}

/// What is seen directly, also in mirrors and through glass. (Their caustics are in L1 of the reference alone.)
TEST(Whitted, ShowsWhatTheReferenceShowsDirectly)
{
    Camera const eye = look_at({0, 0, 0.9}, {0, -0.3, -1}, 60);
    for (bool const smooth : {false, true}) {
        World const world = room(smooth);
        Report report;
        RenderSettings s = picture_of(16, smooth ? 1500 : 64);
        s.of<WhittedSettings>().recursion = 20;
        s.of<WhittedSettings>().cutoff = 1e-4f;
        Picture const trees = render_whitted(world, eye, s, {}, {}, report).picture;
        s.paths = smooth ? 5000 : 600;
        s.bounces = 0;
        Picture const paths = render_reference(world, eye, s, {}, {}, report).picture;
        std::string const layer = smooth ? "L0" : "L1";
        EXPECT_NEAR(mean_of(trees, layer).mean / mean_of(paths, layer).mean, 1, 0.02) << layer;
        EXPECT_EQ(mean_of(trees, "L2").mean, 0);
    }
}

/// In a closed box of mirrors every ray continues until the limit.
TEST(Whitted, RecursionLimitCutsAndCounts)
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, mirror(vec3{0.9f})), true);
    World const world = world_of(scene);
    Report report;
    RenderSettings s = picture_of(8, 2);
    s.of<WhittedSettings>().recursion = 5;
    Picture const p = render_whitted(world, look_at({0, 0, 0}, {0.2, 0.1, 1}, 60), s, {}, {}, report).picture;
    EXPECT_EQ(mean_of(p).mean, 0);
    EXPECT_EQ(report.losses().at("rays cut by the recursion limit or the cut-off weight").count, 8u * 8 * 2);
    double const share = report.counts().at("their mean share of a picture's light, at most");
    EXPECT_GT(share, std::pow(0.9, 6) - 1e-6); // more at grazing angles
    EXPECT_LT(share, 0.6);
}

/// In a furnace of radiance 1, a thin sheet and a mirror of reflectance 1 vanish.
TEST(Whitted, GlassAndMirrorsVanishInAFurnace)
{
    for (Material const& material : {mirror(vec3{1}), glass(1.5f, true)}) {
        Scene scene;
        set_environment(scene, vec3{1});
        add_sphere(scene, {0, 0, 0}, 0.5f, 4, add_material(scene, material), true);
        Report report;
        Picture const p =
            render_whitted(world_of(scene), look_at({0, 0, 2}, {0, 0, 0}, 40), picture_of(24, 4), {}, {}, report)
                .picture;
        EXPECT_NEAR(mean_of(p).mean, 1, 0.01);
    }
}

TEST(Whitted, FramesFollowMovingThings)
{
    Report report;
    auto const scene = std::make_shared<Scene const>(generate_atrium({}));
    MovingWorld moving(scene, 0.0, report);
    Camera const eye = moving.world().cameras.at(0);
    RenderSettings const s = picture_of(24, 2);
    auto const frames = start_whitted_frames(moving, eye, s, report);
    frames->frame(eye, {}, {});
    frames->changed(moving.advance(0.4));
    Picture const moved = frames->frame(eye, {}, {}).picture;
    Picture const anew = render_whitted(build_world(scene, 0.4, report), eye, s, {}, {}, report).picture;
    // Other random numbers, the same scene.
    EXPECT_NEAR(mean_of(moved, "depth").mean, mean_of(anew, "depth").mean, 0.05 * mean_of(anew, "depth").mean);
}

TEST(Whitted, EmptyScenesAreDark)
{
    Report report;
    World const world = world_of(Scene{});
    Picture const p =
        render_whitted(world, look_at({0, 0, 1}, {0, 0, 0}, 60), picture_of(4, 1), {}, {}, report).picture;
    EXPECT_EQ(mean_of(p).mean, 0);
}

} // namespace
} // namespace gi::test
