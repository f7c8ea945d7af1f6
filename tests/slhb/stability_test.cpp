// Hard inputs: the right picture or a message, and never a value that is not finite (render_small checks).

#include "gi/core/error.h"
#include "gi/hit_buffers/settings.h"
#include "gi/methods/reference/reference.h"
#include "tests/slhb/slhb_render.h"

#include <fmt/format.h>

namespace gi::test {
namespace {

/// Means of slhb and reference agree.
void expect_like_reference(World const& world, Camera const& camera, double tolerance, std::string const& what,
                           int bounces = 2)
{
    RenderSettings const s = small_settings(24, 256, bounces);
    StopRequest stop;
    Report report;
    double const truth = mean_of(render_reference(world, camera, s, stop, {}, report).picture).mean;
    EXPECT_NEAR(mean_of(render_small(world, camera, s).result.picture).mean, truth, tolerance * truth + 1e-12)
        << what;
}

/// A lit room; everything scaled and moved.
Scene room(float scale, vec3 at)
{
    Scene scene;
    int const grey = add_material(scene, lambert(vec3{0.6f}));
    auto const place = [&](vec3 p) { return at + scale * p; };
    add_box(scene, place({-1, -1, -1}), place({1, 1, 1}), grey, true);
    add_box(scene, place({-0.4f, -1, -0.4f}), place({0.3f, 0, 0.2f}),
            add_material(scene, lambert(vec3{0.3f, 0.6f, 0.2f})), false);
    add_quad(scene, place({-0.3f, 0.9f, -0.3f}), {0.6f * scale, 0, 0}, {0, 0, 0.6f * scale},
             add_material(scene, emitter(vec3{10})));
    return scene;
}

Camera room_camera(double scale, dvec3 at)
{
    return look_at(at + scale * dvec3{0.8, 0.5, 0.9}, at + scale * dvec3{-0.2, -0.5, -0.3}, 70);
}

TEST(SlhbStability, ScalesFromAMicrometreToAThousandKilometres)
{
    for (float const scale : {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f})
        expect_like_reference(world_of(room(scale, vec3{0})), room_camera(double(scale), dvec3{0}), 0.02,
                              fmt::format("{}", scale));
}

TEST(SlhbStability, FarFromTheOrigin)
{
    // The vertices themselves are floats: at 1e6 m they lie on a grid of 1/16 m, so the room is 1 km wide.
    expect_like_reference(world_of(room(500, vec3{1e6f, -1e6f, 1e6f})), room_camera(500, {1e6, -1e6, 1e6}), 0.02,
                          "far");
}

TEST(SlhbStability, EmptySceneIsBlackAndEmptySkyIsSky)
{
    Camera const camera = look_at({0, 0, 1}, {0, 0, 0}, 45);
    EXPECT_EQ(mean_of(render_small(world_of(Scene{}), camera, small_settings(8, 4, 2)).result.picture).mean,
              0);
    Scene sky;
    set_environment(sky, vec3{2});
    EXPECT_NEAR(mean_of(render_small(world_of(sky), camera, small_settings(8, 4, 2)).result.picture).mean, 2,
                1e-5);
}

TEST(SlhbStability, OneTriangle)
{
    Scene scene;
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.material = add_material(scene, lambert(vec3{0.5f}));
    scene.nodes.emplace_back().meshes = {0};
    set_environment(scene, vec3{1});
    expect_like_reference(world_of(scene), look_at({0, 0, 3}, {0, 0, 0}, 45), 0.01, "one triangle");
}

TEST(SlhbStability, OpenSceneSeenFromBothSides)
{
    Scene scene;
    add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, lambert(vec3{0.5f})));
    add_quad(scene, {-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, add_material(scene, lambert(vec3{0.5f})));
    set_environment(scene, vec3{1});
    World const world = world_of(scene);
    expect_like_reference(world, look_at({0.5, 2, 3}, {0, 0.3, 0}, 45), 0.01, "front");
    expect_like_reference(world, look_at({0.5, -2, -3}, {0, 0.3, 0}, 45), 0.01, "back");
}

TEST(SlhbStability, SliversDegenerateTrianglesAndTJunctions)
{
    Scene scene = room(1, vec3{0});
    int const m = add_material(scene, lambert(vec3{0.6f}));
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.material = m;
    // A wall of slivers, 1 : 10^5, with T-junctions against its neighbours; and triangles without area.
    for (int k = 0; k < 200; ++k) {
        float const y = -0.9f + 0.005f * float(k);
        auto const n = std::uint32_t(mesh.positions.size());
        for (vec3 const p : {vec3{-0.99f, y, -0.9f},
                             {-0.99f, y, 0.9f},
                             {-0.99f, y + 1e-5f, 0},
                             {-0.99f, y + 0.005f, -0.9f},
                             {-0.99f, y + 0.005f, 0.9f}})
            mesh.positions.push_back(p);
        for (uvec3 const t : {uvec3{n, n + 2, n + 1}, uvec3{n, n + 3, n + 2}, uvec3{n + 2, n + 3, n + 4},
                              uvec3{n + 2, n + 4, n + 1}, uvec3{n, n, n + 1}})
            mesh.triangles.push_back(t);
    }
    scene.nodes.emplace_back().meshes = {std::int32_t(scene.meshes.size()) - 1};
    expect_like_reference(world_of(scene), room_camera(1, dvec3{0}), 0.02, "slivers");
}

TEST(SlhbStability, ThinWallsKeepLightOut)
{
    // Two rooms with a common wall of 0.1 texel; a lamp in one of them. Direct light never passes;
    // of indirect light what columns confuse within a texel of the wall, where the two floors
    // are one plane (measured: 0.13 %).
    Scene scene;
    int const grey = add_material(scene, lambert(vec3{0.8f}));
    float const half = 0.05f * 4 / 128;
    add_box(scene, {-2, -1, -1}, {-half, 1, 1}, grey, true);
    add_box(scene, {half, -1, -1}, {2, 1, 1}, grey, true);
    add_quad(scene, {-1.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(vec3{10})));
    World const world = world_of(scene);
    RenderSettings const s = small_settings(24, 256, 4);
    double const lit =
        mean_of(render_small(world, look_at({-1.8, 0.5, 0.9}, {-1, -0.5, -0.3}, 70), s).result.picture).mean;
    Picture const other =
        render_small(world, look_at({1.8, 0.5, 0.9}, {0.2, -0.5, -0.3}, 70), s).result.picture;
    double const dark = mean_of(other).mean;
    EXPECT_LT(mean_of(other, "L1").mean, 1e-3 * lit);
    EXPECT_GT(lit, 0.1);
    EXPECT_LT(dark, 2e-3 * lit);
}

TEST(SlhbStability, AxisAlignedGeometrySeenEdgeOn)
{
    // Stored axes along x, y and z: walls are seen exactly edge-on.
    World const world = world_of(room(1, vec3{0}));
    RenderSettings s = small_settings(24, 256, 2);
    double const truth = mean_of(render_small(world, room_camera(1, dvec3{0}), s).result.picture).mean;
    s.of<SlhbSettings>().schedule = Schedule::stored;
    s.of<SlhbSettings>().directions = "octahedron:128";
    EXPECT_NEAR(mean_of(render_small(world, room_camera(1, dvec3{0}), s).result.picture).mean, truth,
                0.03 * truth);
}

TEST(SlhbStability, LightsOnSurfacesOutsideAndCamerasInsideGeometry)
{
    Scene scene = room(1, vec3{0});
    Light on_floor;
    on_floor.position = {0.6f, -1, 0.6f};
    on_floor.intensity = vec3{0.5f};
    add_light(scene, on_floor);
    Light outside = on_floor;
    outside.position = {0, 5, 0};
    outside.intensity = vec3{100};
    add_light(scene, outside);
    World const world = world_of(scene);
    render_small(world, room_camera(1, dvec3{0}), small_settings(16, 32, 2));
    // Inside of the box: dark but for what nothing lights.
    double const inside =
        mean_of(render_small(world, look_at({0, -0.5, 0}, {0, -0.9, 0.1}, 60), small_settings(16, 32, 2))
                    .result.picture)
            .mean;
    EXPECT_LT(inside, 1e-3);
}

TEST(SlhbStability, AMaskIsCutOutOfTheBuffers)
{
    Scene scene;
    add_quad(scene, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, add_material(scene, lambert(vec3{0.5f})));
    Material veil = lambert(vec3{0.5f});
    veil.alpha_mode = AlphaMode::blend;
    veil.alpha = 0.5f;
    veil.double_sided = true;
    add_quad(scene, {-5, 1, 5}, {10, 0, 0}, {0, 0, -10}, add_material(scene, veil));
    set_environment(scene, vec3{1});
    expect_like_reference(world_of(scene), look_at({0.3, 0.8, 0.5}, {0, 0, 0}, 40), 0.02, "veil");
}

TEST(SlhbStability, ThreadsAndInterruptionsDoNotChangeThePicture)
{
    World const world = world_of(room(1, vec3{0}));
    RenderSettings s = small_settings(80, 5, 3);
    s.threads = 1;
    Picture const one = render_small(world, room_camera(1, dvec3{0}), s).result.picture;
    s.threads = 2;
    s.of<SlhbSettings>().schedule = Schedule::temporal;
    Picture const whole = render_small(world, room_camera(1, dvec3{0}), s).result.picture;
    std::filesystem::path const state = std::filesystem::temp_directory_path() / "lightwell_slhb_test.state";
    std::filesystem::remove(state);
    s.checkpoint = state;
    StopRequest stop;
    Report report;
    auto const after_the_first_pass = [&](RenderStatus const&) { stop.request(); };
    RenderResult const part = render_as_set(world, room_camera(1, dvec3{0}), s, stop, after_the_first_pass, report);
    ASSERT_EQ(part.end, RenderEnd::interrupted);
    s.resume = true;
    EXPECT_EQ(render_small(world, room_camera(1, dvec3{0}), s).result.picture.find("color")->data,
              whole.find("color")->data);
    std::filesystem::remove(state);
    s = small_settings(80, 5, 3);
    EXPECT_EQ(render_small(world, room_camera(1, dvec3{0}), s).result.picture.find("color")->data,
              one.find("color")->data);
}

} // namespace
} // namespace gi::test
