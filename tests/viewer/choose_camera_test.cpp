#include "viewer/offline/choose_camera.h"

#include "gi/core/error.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/model/projection.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace viewer {
namespace {

gi::World box_world(std::vector<gi::Camera> cameras)
{
    gi::Scene scene;
    gi::test::add_box(scene, {1, 2, 3}, {3, 4, 7},
                      gi::test::add_material(scene, gi::test::lambert(gi::vec3{0.5f})), false);
    gi::World world = gi::test::world_of(scene);
    world.cameras = std::move(cameras);
    return world;
}

gi::Camera camera(std::string const& name)
{
    gi::Camera c = gi::look_at({0, 0, 9}, {0, 0, 0}, 30);
    c.name = name;
    return c;
}

TEST(ChooseCamera, FramesAllOfASceneWithoutCameras)
{
    gi::World const world = box_world({});
    ChosenCamera const chosen = choose_camera(world, {});
    EXPECT_FALSE(chosen.note.empty());
    constexpr int kSize = 100;
    gi::CameraRays const rays = gi::camera_rays(chosen.camera, kSize, kSize, world.origin);
    for (gi::vec3 const corner : world.positions) {
        gi::vec3 const p = gi::Projection(rays)(corner);
        EXPECT_GT(p.x, 0);
        EXPECT_LT(p.x, kSize);
        EXPECT_GT(p.y, 0);
        EXPECT_LT(p.y, kSize);
        EXPECT_GT(p.z, 0);
    }
}

TEST(ChooseCamera, TakesTheFirstOrTheNamedOne)
{
    gi::World const world = box_world({camera("front"), camera("side")});
    EXPECT_EQ(choose_camera(world, {}).camera.name, "front");
    CameraChoice choice;
    choice.name = "side";
    choice.fov_deg = 60;
    ChosenCamera const chosen = choose_camera(world, choice);
    EXPECT_EQ(chosen.camera.name, "side");
    EXPECT_DOUBLE_EQ(chosen.camera.yfov_rad, glm::radians(60.0));
    EXPECT_TRUE(chosen.note.empty());
}

TEST(ChooseCamera, UnknownNamesAreAnsweredWithTheKnownOnes)
{
    CameraChoice choice;
    choice.name = "back";
    try {
        choose_camera(box_world({camera("front"), camera("side")}), choice);
        FAIL();
    } catch (gi::InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("front, side"), std::string::npos) << e.what();
    }
}

TEST(ChooseCamera, PutsALensBeforeTheCamera)
{
    gi::World world = box_world({camera("front"), camera("side")}); // from (0, 0, 9), along -z
    world.cameras[1].aperture_radius_m = 0.5;
    world.cameras[1].focus_distance_m = 7;
    CameraChoice choice;
    choice.aperture_radius_m = 0.02;
    ChosenCamera chosen = choose_camera(world, choice);
    EXPECT_EQ(chosen.camera.aperture_radius_m, 0.02);
    EXPECT_NEAR(chosen.camera.focus_distance_m, 4, 1e-6) << "the middle of the scene is at z = 5";
    EXPECT_FALSE(chosen.note.empty());

    choice.name = "side";
    chosen = choose_camera(world, choice);
    EXPECT_EQ(chosen.camera.focus_distance_m, 7) << "its own";
    EXPECT_TRUE(chosen.note.empty());
    choice.focus_distance_m = 3;
    EXPECT_EQ(choose_camera(world, choice).camera.focus_distance_m, 3);
    choice.aperture_radius_m = 0;
    EXPECT_THROW(choose_camera(world, choice), gi::InputError) << "a pinhole has no focus";
    choice.focus_distance_m = {};
    EXPECT_EQ(choose_camera(world, choice).camera.aperture_radius_m, 0);

    CameraChoice at;
    at.look_from = gi::dvec3{2, 3, 0};
    at.look_at = gi::dvec3{2, 3, -2};
    at.aperture_radius_m = 0.1;
    EXPECT_DOUBLE_EQ(choose_camera(world, at).camera.focus_distance_m, 2);

    CameraChoice away;
    away.aperture_radius_m = 0.1;
    world.cameras[0] = gi::look_at({0, 0, 9}, {0, 0, 10}, 30);
    EXPECT_THROW(choose_camera(world, away), gi::InputError) << "the middle of the scene is behind it";
    world.cameras[0] = camera("front");
    world.cameras[0].orthographic = true;
    away.focus_distance_m = 1;
    EXPECT_THROW(choose_camera(world, away), gi::InputError);
}

TEST(ChooseCamera, RefusesContradictions)
{
    gi::World world = box_world({camera("front")});
    CameraChoice both;
    both.name = "front";
    both.look_from = gi::dvec3{1, 1, 1};
    EXPECT_THROW(choose_camera(world, both), gi::InputError);
    CameraChoice only_at;
    only_at.look_at = gi::dvec3{1, 1, 1};
    EXPECT_THROW(choose_camera(world, only_at), gi::InputError);
    CameraChoice far;
    far.look_from = gi::dvec3{1e30, 0, 0};
    EXPECT_THROW(choose_camera(world, far), gi::InputError);

    world.cameras.front().orthographic = true;
    CameraChoice fov;
    fov.fov_deg = 40;
    EXPECT_THROW(choose_camera(world, fov), gi::InputError);
}

} // namespace
} // namespace viewer
