// On foot: eyes at their height above the floor, steps climbed, falls and walls not walked into.

#include "tests/support/scenes.h"
#include "viewer/engine/live/navigation.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

using gi::dmat4, gi::dvec3;
using gi::test::add_box, gi::test::add_quad;

/// A floor of 20 x 20 m at y = 0 with boxes on it, from low to high; -Z is ahead.
std::shared_ptr<Ground const> ground_with(std::vector<std::pair<gi::vec3, gi::vec3>> const& boxes,
                                          double floor_depth_m = 20)
{
    gi::Scene scene;
    add_quad(scene, {-10, 0, 10 - float(floor_depth_m)}, {0, 0, float(floor_depth_m)}, {20, 0, 0}, -1);
    for (auto const& [low, high] : boxes) add_box(scene, low, high, -1, false);
    return std::make_shared<Ground const>(gi::test::world_of(std::move(scene)));
}

WalkStance at(double x, double z) { return {{x, 0, z}, 1.6}; }

TEST(Walking, TheFloorIsFoundBelow)
{
    auto const ground = ground_with({{{-1, 0, -1}, {1, 0.7f, 1}}});
    auto const on_box = stand_below(*ground, {0, 3, 0}, 1.6);
    ASSERT_TRUE(on_box);
    EXPECT_NEAR(on_box->foot.y, 0.7, 1e-5);
    EXPECT_EQ(on_box->eye_m, 1.6);
    EXPECT_NEAR(stand_below(*ground, {4, 90, 0}, 1.6)->foot.y, 0, 1e-4);
    EXPECT_FALSE(stand_below(*ground, {30, 3, 0}, 1.6)) << "nothing is there";
}

TEST(Walking, LowCeilingsAreStoodUnder)
{
    auto const ground = ground_with({{{-1, 1, -1}, {1, 2, 1}}});
    EXPECT_NEAR(stand_below(*ground, {0, 0.6, 0}, 1.6)->eye_m, 0.9, 0.02);
}

TEST(Walking, StepsAreClimbedUpToTheLimit)
{
    // A staircase of 0.2 m steps, 0.3 m deep each, that ends in a wall of 0.6 m.
    std::vector<std::pair<gi::vec3, gi::vec3>> stairs;
    for (int i = 1; i <= 8; ++i) stairs.push_back({{-2, 0, -10}, {2, 0.2f * float(i), -0.3f * float(i)}});
    auto const ground = ground_with(stairs);
    WalkStance const up = walk(*ground, at(0, 1), {0, 0, -6});
    EXPECT_NEAR(up.foot.y, 1.6, 1e-4);
    EXPECT_NEAR(up.foot.z, -5, 1e-6);
    WalkStance const down = walk(*ground, up, {0, 0, 6});
    EXPECT_NEAR(down.foot.y, 0, 1e-4);
    auto const high = ground_with({{{-2, 0, -10}, {2, 0.39f, -1}}, {{-2, 0, -10}, {2, 0.85f, -3}}});
    WalkStance const blocked = walk(*high, at(0, 1), {0, 0, -6});
    EXPECT_NEAR(blocked.foot.y, 0.39, 1e-4) << "0.39 m are climbed, 0.46 m are not";
    EXPECT_GT(blocked.foot.z, -3.0);
    EXPECT_LT(blocked.foot.z, -2.6);
}

TEST(Walking, DeepFallsAreNotSteppedInto)
{
    auto const low = ground_with({{{-1, 0, -2}, {1, 0.9f, 2}}}), high = ground_with({{{-1, 0, -2}, {1, 1.1f, 2}}});
    WalkStance const from_low = walk(*low, {{0, 0.9, 0}, 1.6}, {0, 0, -5});
    EXPECT_NEAR(from_low.foot.y, 0, 1e-4) << "0.9 m are stepped down";
    WalkStance const from_high = walk(*high, {{0, 1.1, 0}, 1.6}, {0, 0, -5});
    EXPECT_NEAR(from_high.foot.y, 1.1, 1e-4);
    EXPECT_NEAR(from_high.foot.z, -2, 0.11) << "to the edge";
    // The end of the world.
    EXPECT_LE(std::abs(walk(*low, at(5, 0), {40, 0, 0}).foot.x), 10);
}

TEST(Walking, WallsAreNotWalkedThrough)
{
    auto const ground = ground_with({{{-5, 0, -3.05f}, {5, 3, -3}}});
    WalkStance const straight = walk(*ground, at(0, 0), {0, 0, -8});
    EXPECT_NEAR(straight.foot.z, -2.75, 0.01) << "a body's radius before it";
    WalkStance const along = walk(*ground, at(0, 0), {-4, 0, -4});
    EXPECT_NEAR(along.foot.z, -2.75, 0.01);
    EXPECT_NEAR(along.foot.x, -4, 0.1) << "it slides";
    // A low lintel is a wall; a high one is not.
    auto const lintels = ground_with({{{-5, 1.5f, -3.05f}, {0, 3, -3}}, {{0, 2, -3.05f}, {5, 3, -3}}});
    EXPECT_GT(walk(*lintels, at(-2, 0), {0, 0, -8}).foot.z, -3);
    EXPECT_NEAR(walk(*lintels, at(2, 0), {0, 0, -8}).foot.z, -8, 1e-6);
    // A corner holds.
    auto const corner = ground_with({{{-5, 0, -3.05f}, {5, 3, -3}}, {{2, 0, -5}, {2.05f, 3, 5}}});
    WalkStance const held = walk(*corner, at(0, 0), {30, 0, -30});
    EXPECT_NEAR(held.foot.x, 1.75, 0.05);
    EXPECT_NEAR(held.foot.z, -2.75, 0.05);
}

TEST(Walking, WhatMovesIsNoGround)
{
    gi::Scene scene;
    add_quad(scene, {-10, 0, -10}, {0, 0, 20}, {20, 0, 0}, -1);
    add_box(scene, {-1, 0, -1}, {1, 2, 1}, -1, false);
    for (std::size_t n = 1; n < scene.nodes.size(); ++n) scene.nodes[n].driven = true;
    gi::Report report;
    Ground const ground(gi::build_world(std::make_shared<gi::Scene const>(std::move(scene)), 0.0, report));
    EXPECT_NEAR(stand_below(ground, {0, 3, 0}, 1.6)->foot.y, 0, 1e-5);
}

TEST(Walking, AWorldOfNothingIsNoGround)
{
    Ground const ground(gi::test::world_of(gi::Scene()));
    EXPECT_FALSE(ground.touch({0, 1, 0}, {0, -1, 0}, 10));
}

dmat4 looking_at(dvec3 from, dvec3 at) { return gi::look_at(from, at, 45).world_from_camera; }

Navigation walker(std::shared_ptr<Ground const> ground, dvec3 from, double speed_m_s = 1.4)
{
    Navigation n(looking_at(from, from + dvec3{0, -0.3, -1}), speed_m_s, {});
    n.set_mode(NavigationMode::walk);
    n.set_eye_height(1.7);
    n.set_ground(std::move(ground));
    return n;
}

TEST(NavigationOnFoot, EyesFollowTheFloor)
{
    auto const ground = ground_with({{{-2, 0, -10}, {2, 0.3f, -1}}});
    Navigation n = walker(ground, {0, 2.5, 0});
    EXPECT_EQ(n.position(), dvec3(0, 2.5, 0)) << "until the first step it is where it was put";
    n.step({.turn_right_rad = 0.01}, 0.02);
    EXPECT_EQ(n.position(), dvec3(0, 2.5, 0)) << "turning is no step";
    n.step({.forward = 1}, 0.02);
    EXPECT_NEAR(n.position().y, 1.7, 1e-5);
    double highest_rise = 0, before = n.position().y;
    for (int i = 0; i < 100; ++i) {
        n.step({.forward = 1}, 0.02);
        highest_rise = std::max(highest_rise, n.position().y - before);
        before = n.position().y;
    }
    EXPECT_NEAR(n.position().y, 2.0, 1e-5);
    EXPECT_LT(highest_rise, 0.05) << "the eyes do not jump";
    dvec3 const rests = n.position();
    for (int i = 0; i < 10; ++i) n.step({}, 0.02);
    EXPECT_EQ(n.position(), rests) << "to the bit";
}

TEST(NavigationOnFoot, FastOnesDoNotGetThroughWalls)
{
    Navigation n = walker(ground_with({{{-10, 0, -3.01f}, {10, 3, -3}}}), {0, 1.7, 0}, 20);
    for (int i = 0; i < 5; ++i) n.step({.forward = 1, .fast = true}, 0.1);
    EXPECT_GT(n.position().z, -3);
}

TEST(NavigationOnFoot, WithoutAFloorItStaysOnTheLevel)
{
    Navigation n = walker(ground_with({}, 5), {0, 2, -3});
    n.step({.forward = 1}, 0.1);
    EXPECT_EQ(n.position().y, 2);
    EXPECT_LT(n.position().z, -3);
    n.set_mode(NavigationMode::fly);
    n.step({.up = 1}, 0.1);
    EXPECT_GT(n.position().y, 2);
}

TEST(NavigationOnFoot, GoingElsewhereIsNotHeldByTheFloor)
{
    Navigation n = walker(ground_with({}), {0, 1.7, 0});
    n.step({.forward = 1}, 0.1);
    n.go_to(looking_at({5, 8, 5}, {0, 0, 0}));
    n.step({}, 0.1);
    EXPECT_EQ(n.position(), dvec3(5, 8, 5));
    n.step({.right = 1}, 0.1);
    EXPECT_NEAR(n.position().y, 1.7, 1e-5);
}

} // namespace
} // namespace viewer::test
