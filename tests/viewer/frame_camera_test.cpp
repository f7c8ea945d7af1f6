// The turntable.

#include "viewer/offline/frame_camera.h"

#include "gi/core/error.h"
#include "gi/scene/model/projection.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>
#include <numbers>

namespace viewer {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Its middle is (2, 3, 5).
gi::World box_world()
{
    gi::Scene scene;
    gi::test::add_box(scene, {1, 2, 3}, {3, 4, 7},
                      gi::test::add_material(scene, gi::test::lambert(gi::vec3{0.5f})), false);
    return gi::test::world_of(scene);
}

gi::dvec3 place(gi::Camera const& c) { return gi::dvec3(c.world_from_camera[3]); }

TEST(Turntable, CirclesTheMiddleOfTheScene)
{
    gi::World const world = box_world();
    CameraChoice choice;
    choice.look_from = gi::dvec3{2, 4, 15};
    FrameCamera const camera(world, choice, {std::nullopt, kTurn});
    gi::dvec3 const center{2, 3, 5};
    EXPECT_LT(glm::length(place(camera.of(world, 0, 0)) - *choice.look_from), 1e-12);
    EXPECT_LT(glm::length(place(camera.of(world, 0, 0.25)) - gi::dvec3(12, 4, 5)), 1e-12) << "from +z to +x";
    for (int k = 0; k <= 16; ++k) {
        gi::dmat4 const m = camera.of(world, 0, k / 16.0).world_from_camera;
        gi::dvec3 const to = center - gi::dvec3(m[3]);
        EXPECT_NEAR(glm::length(to), std::sqrt(101.0), 1e-12);
        EXPECT_NEAR(m[3].y, 4, 1e-12);
        EXPECT_LT(glm::length(glm::normalize(to) + gi::dvec3(m[2])), 1e-12) << "looks at the middle";
    }
    EXPECT_LT(glm::length(place(camera.of(world, 0, 1)) - place(camera.of(world, 0, 0))), 1e-12) << "once round";
}

TEST(Turntable, CirclesThePointLookedAt)
{
    gi::World const world = box_world();
    CameraChoice choice;
    choice.look_from = gi::dvec3{0, 0, 4};
    choice.look_at = gi::dvec3{0, 0, 1};
    FrameCamera const camera(world, choice, {std::nullopt, -kTurn});
    EXPECT_LT(glm::length(place(camera.of(world, 0, 0.25)) - gi::dvec3(-3, 0, 1)), 1e-12);
}

TEST(Turntable, TakesTurnsAndDegrees)
{
    EXPECT_DOUBLE_EQ(parse_turn(""), kTurn);
    EXPECT_DOUBLE_EQ(parse_turn("2"), 2 * kTurn);
    EXPECT_DOUBLE_EQ(parse_turn("-0.5"), -0.5 * kTurn);
    EXPECT_DOUBLE_EQ(parse_turn("90deg"), 0.25 * kTurn);
    for (char const* text : {"0", "nan", "inf", "1e9", "deg", "90°", "once", "1 "})
        EXPECT_THROW(parse_turn(text), gi::InputError) << text;
}

TEST(FrameCamera, AnimatedCamerasMoveAndTheFramingOneRests)
{
    gi::World first = box_world(), second = first;
    second.bounds.high += 10.0f;
    FrameCamera const framing(first, {}, {});
    EXPECT_FALSE(framing.note().empty());
    EXPECT_EQ(framing.of(first, 0, 0).world_from_camera, framing.of(second, 1, 0.5).world_from_camera);

    first.cameras = {gi::look_at({0, 0, 9}, {0, 0, 0}, 30)};
    second.cameras = {gi::look_at({0, 1, 9}, {0, 0, 0}, 30)};
    FrameCamera const animated(first, {}, {});
    EXPECT_EQ(animated.of(second, 1, 0.5).world_from_camera, second.cameras[0].world_from_camera);
}

TEST(FrameCamera, AFocusOnceChosenStays)
{
    gi::World first = box_world(), second = first;
    first.cameras = second.cameras = {gi::look_at({0, 0, 9}, {0, 0, 0}, 30)};
    second.bounds.high += 10.0f;
    CameraChoice choice;
    choice.aperture_radius_m = 0.1;
    FrameCamera const camera(first, choice, {});
    EXPECT_FALSE(camera.note().empty());
    EXPECT_NEAR(camera.of(first, 0, 0).focus_distance_m, 4, 1e-6);
    EXPECT_EQ(camera.of(second, 0, 0).focus_distance_m, camera.of(first, 0, 0).focus_distance_m);

    gi::CameraPath path;
    path.keys.emplace_back().from = {0, 0, 9};
    EXPECT_THROW(FrameCamera(first, choice, {path, 0}), gi::InputError) << "how far is not known on a path";
    choice.focus_distance_m = 3;
    EXPECT_EQ(FrameCamera(first, choice, {path, 0}).of(first, 0, 0).focus_distance_m, 3);
}

TEST(FrameCamera, TwoEyesShareAScreen)
{
    gi::World const world = box_world();
    CameraChoice choice;
    choice.look_from = gi::dvec3{2, 3, 15};
    choice.look_at = gi::dvec3{2, 3, 5};
    choice.eye = EyeChoice{false, 0.07, 4, {300, 200}};
    gi::Camera const left = FrameCamera(world, choice, {}).of(world, 0, 0);
    choice.eye->right = true;
    gi::Camera const right = FrameCamera(world, choice, {}).of(world, 0, 0);
    EXPECT_LT(glm::length(place(right) - place(left) - gi::dvec3(0.07, 0, 0)), 1e-12);
    EXPECT_LT(glm::length(0.5 * (place(right) + place(left)) - *choice.look_from), 1e-12);
    gi::CameraRays const l = gi::camera_rays(left, 300, 200, {}), r = gi::camera_rays(right, 300, 200, {});
    gi::vec3 const on_screen{2.5f, 3.4f, 11}, behind{2.5f, 3.4f, 7};
    EXPECT_NEAR(gi::Projection(l)(on_screen).x, gi::Projection(r)(on_screen).x, 1e-3);
    EXPECT_NEAR(gi::Projection(l)(on_screen).y, gi::Projection(r)(on_screen).y, 1e-3);
    EXPECT_LT(gi::Projection(l)(behind).x, gi::Projection(r)(behind).x - 1)
        << "what is behind it is farther apart";
}

TEST(FrameCamera, TheScreenOfTwoEyesIsInTheMiddleOfTheSceneAndStays)
{
    gi::World first = box_world(), second = first;
    first.cameras = {gi::look_at({2, 3, 15}, {2, 3, 5}, 30)};
    second.cameras = {gi::look_at({2, 3, 25}, {2, 3, 5}, 30)};
    CameraChoice choice, told;
    choice.eye = EyeChoice{true, 0.063, std::nullopt, {64, 48}};
    told.eye = EyeChoice{true, 0.063, 10, {64, 48}};
    FrameCamera const found(first, choice, {});
    EXPECT_NE(found.note().find("10 m in front of the camera"), std::string::npos) << found.note();
    for (gi::World const* const world : {&first, &second})
        EXPECT_EQ(found.of(*world, 0, 0), FrameCamera(first, told, {}).of(*world, 0, 0));

    first.cameras[0].orthographic = true;
    EXPECT_THROW(FrameCamera(first, told, {}), gi::InputError) << "it has no eyes";
}

} // namespace
} // namespace viewer
