// Geometry that breaks naive ray tracers: empty, tiny, huge, far away, grazing, thin, coplanar, closed.

#include "gi/methods/reference/reference.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

RenderResult render(World const& world, Camera const& camera, std::uint32_t paths = 256, int bounces = 0)
{
    RenderSettings s;
    s.width = s.height = 16;
    s.paths = paths;
    s.bounces = bounces;
    StopRequest stop;
    Report report;
    RenderResult r = render_reference(world, camera, s, stop, {}, report);
    EXPECT_EQ(report.losses().count("path terms that were not finite, dropped"), 0u);
    for (Layer const& l : r.picture.layers)
        for (float const v : l.data) EXPECT_TRUE(std::isfinite(v)) << l.name;
    return r;
}

TEST(HardCases, EmptySceneIsBlack)
{
    EXPECT_EQ(mean_of(render(world_of({}), look_at({0, 0, 1}, {0, 0, 0}, 40)).picture).mean, 0);
}

TEST(HardCases, EmptySceneShowsItsEnvironment)
{
    Scene scene;
    set_environment(scene, vec3{2});
    EXPECT_NEAR(mean_of(render(world_of(scene), look_at({0, 0, 1}, {0, 0, 0}, 40)).picture).mean, 2, 1e-4);
}

/// A floor under a uniform sky keeps its radiance at every size: no self-shadowing, no leaking.
TEST(HardCases, SkyOverFloorAtEveryScale)
{
    for (float const scale : {1e-6f, 1e-3f, 1.0f, 1e4f, 1e7f}) {
        Scene scene;
        set_environment(scene, vec3{1});
        add_quad(scene, scale * vec3{-1, 0, 1}, scale * vec3{2, 0, 0}, scale * vec3{0, 0, -2},
                 add_material(scene, lambert(vec3{0.5f})));
        double const s = double(scale);
        Picture const p = render(world_of(scene), orthographic({0, s, 0}, {0, 0, 0}, s), 1024).picture;
        EXPECT_NEAR(mean_of(p).mean, 0.5, 0.5 * 0.01) << scale;
    }
}

TEST(HardCases, FarFromTheOrigin)
{
    for (double const away : {1e3, 1e6, 1e8}) {
        Scene scene;
        set_environment(scene, vec3{1});
        add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, lambert(vec3{0.5f})));
        dvec3 const at{away, -away, 0.5 * away};
        scene.nodes[0].translation = at;
        Picture const p = render(world_of(scene), orthographic(at + dvec3{0, 1, 0}, at, 1), 1024).picture;
        EXPECT_NEAR(mean_of(p).mean, 0.5, 0.005) << away;
        // float positions: half a metre at 1e7, by construction of the format
        EXPECT_NEAR(double(rgb(*p.find("position"), 0).x), away, 1e-6 * away + 1) << away;
    }
}

TEST(HardCases, GrazingViewOfAFloor)
{
    Scene scene;
    set_environment(scene, vec3{1});
    add_quad(scene, {-1000, 0, 1000}, {2000, 0, 0}, {0, 0, -2000}, add_material(scene, lambert(vec3{0.5f})));
    Picture const p = render(world_of(scene), look_at({0, 0.01, 0}, {100, 0, 0}, 0.001), 512).picture;
    EXPECT_NEAR(mean_of(p).mean, 0.5, 0.01);
}

/// A sheet a millionth of its size above a floor hides it completely; the space between stays dark.
TEST(HardCases, ThinGapLetsNoLightThrough)
{
    Scene scene;
    set_environment(scene, vec3{1});
    int const grey = add_material(scene, lambert(vec3{0.5f}));
    add_box(scene, {-1, 0, -1}, {1, 1e-3f, 1}, grey, false);
    add_box(scene, {-0.9f, 2e-4f, -0.9f}, {0.9f, 8e-4f, 0.9f}, grey, true); // a closed cavity inside the slab
    Picture const p = render(world_of(scene), orthographic({0, 5e-4, 0}, {0, 2e-4, 0}, 1), 256, 8).picture;
    EXPECT_EQ(mean_of(p).mean, 0);
}

TEST(HardCases, CoplanarTwinsAreOneSurface)
{
    Scene scene;
    set_environment(scene, vec3{1});
    int const grey = add_material(scene, lambert(vec3{0.5f}));
    for (int i = 0; i < 2; ++i) add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, grey);
    Picture const p = render(world_of(scene), orthographic({0, 1, 0}, {0, 0, 0}, 1), 1024).picture;
    EXPECT_NEAR(mean_of(p).mean, 0.5, 0.005);
}

TEST(HardCases, ClosedRoomKeepsTheSkyOut)
{
    Scene scene;
    set_environment(scene, vec3{1000});
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.9f})), true);
    add_sphere(scene, {0, 0, 0}, 0.9f, 4, add_material(scene, lambert(vec3{0.9f})), true);
    Picture const p = render(world_of(scene), look_at({0, 0, 0}, {1, 1, 1}, 100), 512, 20).picture;
    EXPECT_EQ(mean_of(p).mean, 0);
}

/// It sees what lies before it, not the surface.
TEST(HardCases, CameraInASurface)
{
    for (dvec3 const away : {dvec3{0}, dvec3{100, 0, -30}}) {
        Scene scene;
        set_environment(scene, vec3{1});
        add_quad(scene, vec3(away) + vec3{-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, lambert(vec3{0})));
        dvec3 const from = away + dvec3{0.3, 0, 0.2};
        Picture const above = render(world_of(scene), look_at(from, from + dvec3{0.1, 1, 0}, 60)).picture;
        EXPECT_EQ(mean_of(above).mean, 1) << away.x;
        Picture const across = render(world_of(scene), look_at(from, from + dvec3{1, 0, 0}, 60)).picture;
        EXPECT_EQ(mean_of(across).mean, 1) << away.x;
    }
}

TEST(HardCases, LampTouchingAWall)
{
    Scene scene;
    add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, lambert(vec3{0.5f})));
    add_quad(scene, {0, 0, 0.5f}, {0, 0, -1}, {0, 1, 0}, add_material(scene, emitter(vec3{1}, true)));
    Estimate const e =
        mean_of(render(world_of(scene), orthographic({0.5, 0.5, 0}, {0.5, 0, 0}, 0.9), 1024).picture, "L1");
    EXPECT_GT(e.mean, 0.05);
    EXPECT_LT(e.sigma, 0.01 * e.mean);
}

} // namespace
} // namespace gi::test
