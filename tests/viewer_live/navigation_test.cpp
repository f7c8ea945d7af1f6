#include "gi/scene/model/projection.h"
#include "viewer/displays/desktop_views.h"
#include "viewer/engine/live/navigation.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

using gi::dmat4, gi::dvec3;

void expect_near(dvec3 a, dvec3 b, double error)
{
    EXPECT_LT(glm::length(a - b), error)
        << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

dmat4 looking(dvec3 from, dvec3 at) { return gi::look_at(from, at, 45).world_from_camera; }

TEST(Navigation, StartsWhereTheCameraIs)
{
    for (dvec3 const at : {dvec3{1, 2, -3}, dvec3{4, -2, 1}, dvec3{-5, 0.1, 0}, dvec3{0, 0, 8}}) {
        dmat4 const start = looking({0.5, 1, 0}, at);
        dmat4 const found = Navigation(start, 1, {}).world_from_camera();
        for (int c = 0; c < 4; ++c) expect_near(dvec3(found[c]), dvec3(start[c]), 1e-9);
    }
}

TEST(Navigation, StraightDownIsTaken)
{
    Navigation n(looking({0, 5, 0}, {0, 0, 0}), 1, {});
    EXPECT_LT(-n.world_from_camera()[2].y, -0.99);
    n.step({.forward = 1}, 0.1);
    EXPECT_TRUE(std::isfinite(glm::length(n.position())));
}

TEST(Navigation, FliesAlongTheViewAndWalksOnTheLevel)
{
    dmat4 const down = looking({0, 2, 0}, {0, 1, -1});
    Navigation fly(down, 2, {}), walk(down, 2, {});
    walk.set_mode(NavigationMode::walk);
    for (int i = 0; i < 10; ++i) {
        fly.step({.forward = 1}, 0.05);
        walk.step({.forward = 1}, 0.05);
    }
    expect_near(fly.position(), dvec3{0, 2 - std::sqrt(0.5), -std::sqrt(0.5)}, 1e-9);
    expect_near(walk.position(), dvec3{0, 2, -1}, 1e-9);
    fly.step({.right = 1, .fast = true}, 0.05);
    EXPECT_NEAR(fly.position().x, 0.4, 1e-9);
    fly.step({.forward = 1}, 1e9); // a pause is no journey
    EXPECT_LT(glm::length(fly.position()), 4);
}

TEST(Navigation, OrbitKeepsItsDistance)
{
    Navigation n(looking({3, 1, 3}, {0, 0, 0}), 1, {0, 0, 0});
    n.set_mode(NavigationMode::orbit);
    double const distance = glm::length(n.position());
    for (int i = 0; i < 100; ++i) {
        n.step({.turn_right_rad = 0.1, .turn_up_rad = 0.02}, 0.01);
        EXPECT_NEAR(glm::length(n.position()), distance, 1e-9);
        expect_near(glm::normalize(dvec3(n.world_from_camera()[2])), glm::normalize(n.position()), 1e-9);
    }
    n.step({.closer = 5}, 0.01);
    EXPECT_LT(glm::length(n.position()), distance);
}

/// A point on the virtual screen is at the same place of both pictures; nearer ones are crossed.
TEST(DesktopViews, DisparityIsWhatGeometrySays)
{
    gi::Camera middle = gi::look_at({1, 2, 3}, {1, 2, 0}, 50);
    DesktopStereo const stereo{true, 0.064, 1.5};
    auto const views = desktop_views(middle, stereo, {800, 600}, {800, 600});
    ASSERT_EQ(views.size(), 2u);
    EXPECT_EQ(views[1].partner, 0);
    double const pixels_per_m = 600 / (2 * std::tan(0.5 * middle.yfov_rad)) / 1.5; // on the screen
    for (double const depth : {0.5, 1.5, 10.0}) {
        gi::vec3 const point{1.1f, 1.9f, float(3 - depth)};
        auto const at = [&](int k) {
            return gi::Projection(gi::camera_rays(views[std::size_t(k)].camera, 800, 600, dvec3{0}))(point);
        };
        double const disparity = stereo.eye_distance_m * (depth - stereo.screen_distance_m) / depth * pixels_per_m;
        EXPECT_NEAR(double(at(1).x - at(0).x), disparity, 1e-3) << depth;
        EXPECT_NEAR(double(at(1).y - at(0).y), 0, 1e-4);
    }
    EXPECT_EQ(desktop_views(middle, {}, {800, 600}, {800, 600}).size(), 1u);
}

TEST(DesktopViews, HalvesOfAWindowHoldTheWholeView)
{
    gi::Camera const middle = gi::look_at({1, 2, 3}, {1, 2, 0}, 50);
    DesktopStereo const stereo{true, 0.064, 1.5};
    auto const whole = desktop_views(middle, stereo, {800, 600}, {800, 600});
    auto const half = desktop_views(middle, stereo, {800, 600}, {400, 600});
    ASSERT_EQ(half.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_EQ(half[k].camera, whole[k].camera);
        EXPECT_EQ(half[k].width, 400);
        EXPECT_EQ(half[k].height, 600);
    }
}

} // namespace
} // namespace viewer::test
