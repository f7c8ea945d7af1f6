// Where viewers start in scenes without a camera.

#include "viewer/offline/first_view.h"

#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

using gi::test::add_box, gi::test::add_material, gi::test::add_quad, gi::test::add_sphere, gi::test::lambert;

constexpr double kFov_deg = 65;

gi::dvec3 place_of(gi::Camera const& c) { return gi::dvec3(c.world_from_camera[3]); }

/// A long room with a floor at y = 0, and things in it, scaled.
gi::Scene room_of(float s)
{
    gi::Scene scene;
    int const grey = add_material(scene, lambert(gi::vec3{0.5f}));
    add_box(scene, s * gi::vec3{-6, 0, -2}, s * gi::vec3{6, 3, 2}, grey, true);
    add_sphere(scene, s * gi::vec3{5, 0.5f, 0}, s * 0.5f, 3, grey, true);
    add_box(scene, s * gi::vec3{-4.5f, 0, -1.9f}, s * gi::vec3{-3.5f, 2, -1}, grey, false);
    return scene;
}

TEST(FirstView, StandsInARoomAndLooksAlongIt)
{
    gi::World const world = gi::test::world_of(room_of(1));
    auto const view = view_from_inside(world, kFov_deg);
    ASSERT_TRUE(view);
    gi::dvec3 const at = place_of(*view), look = -gi::dvec3(view->world_from_camera[2]);
    EXPECT_NEAR(at.y, 1.6, 0.05) << "eye height above the floor";
    EXPECT_LT(std::abs(at.x), 6);
    EXPECT_LT(std::abs(at.z), 2);
    EXPECT_NEAR(look.y, 0, 1e-6);
    EXPECT_GT(std::abs(look.x), 0.7) << "along the room";
    auto const again = view_from_inside(world, kFov_deg);
    EXPECT_EQ(again->world_from_camera, view->world_from_camera);
}

TEST(FirstView, OfAnySize)
{
    for (float const s : {0.001f, 1000.0f}) {
        auto const view = view_from_inside(gi::test::world_of(room_of(s)), kFov_deg);
        ASSERT_TRUE(view) << s;
        EXPECT_GT(place_of(*view).y, 0.3 * double(s)) << s;
        EXPECT_LT(place_of(*view).y, 3 * double(s)) << s;
    }
}

TEST(FirstView, AWideGroundDoesNotCount)
{
    gi::Scene scene = room_of(1);
    int const ground = add_material(scene, lambert(gi::vec3{0.3f}));
    add_quad(scene, {-5000, -0.1f, 5000}, {10000, 0, 0}, {0, 0, -10000}, ground);
    gi::World const world = gi::test::world_of(std::move(scene));
    gi::Bounds const part = detailed_part(world);
    EXPECT_LT(part.high.x - part.low.x, 20);
    auto const view = view_from_inside(world, kFov_deg);
    ASSERT_TRUE(view);
    EXPECT_LT(std::abs(place_of(*view).x), 6);
}

TEST(FirstView, ObjectsAreSeenFromOutside)
{
    gi::Scene alone;
    add_sphere(alone, {0, 1, 0}, 1, 4, add_material(alone, lambert(gi::vec3{0.5f})), true);
    EXPECT_FALSE(view_from_inside(gi::test::world_of(alone), kFov_deg));
    add_quad(alone, {-500, 0, 500}, {1000, 0, 0}, {0, 0, -1000}, 0);
    gi::World const world = gi::test::world_of(alone);
    EXPECT_FALSE(view_from_inside(world, kFov_deg)) << "on a ground";
    gi::Camera const view = view_from_outside(world, detailed_part(world), 45);
    EXPECT_LT(glm::length(place_of(view)), 20) << "near the object, whatever its ground";
}

TEST(FirstView, ABoxWithAnOpenSideIsSeenFromItsFront)
{
    gi::Scene scene;
    int const grey = add_material(scene, lambert(gi::vec3{0.5f}));
    add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, grey);
    add_quad(scene, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, grey);
    add_quad(scene, {-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, grey);
    add_quad(scene, {-1, 0, 1}, {0, 0, -2}, {0, 2, 0}, grey);
    add_quad(scene, {1, 0, -1}, {0, 0, 2}, {0, 2, 0}, grey);
    EXPECT_FALSE(view_from_inside(gi::test::world_of(std::move(scene)), kFov_deg));
}

TEST(FirstView, NothingAndFlatScenesAreNoRooms)
{
    EXPECT_FALSE(view_from_inside(gi::test::world_of({}), kFov_deg));
    gi::Scene flat;
    add_quad(flat, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, add_material(flat, lambert(gi::vec3{0.5f})));
    EXPECT_FALSE(view_from_inside(gi::test::world_of(std::move(flat)), kFov_deg));
    gi::Camera const c = view_from_outside(gi::test::world_of({}), {}, 45);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(c.world_from_camera[3][i]));
}

} // namespace
} // namespace viewer::test
