// Feet that nobody tracks: they stand on the floor and step after their user, one at a time.

#include "gi/core/pose.h"
#include "viewer/devices/tracking/footsteps.h"

#include "tests/viewer_tracking/pose_checks.h"
#include "viewer/devices/tracking/known_walk.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

using gi::dvec3;

constexpr double kStep_s = 0.01;

Tracked head_at(dvec3 position, double yaw_rad = 0)
{
    Tracked t;
    t.head = RoomPose{position, gi::exp_rotation({0, yaw_rad, 0})};
    return t;
}

/// A user with his feet, of whom a head is all that is tracked.
struct Walker {
    Footsteps feet{Stance{}};
    gi::dmat4 world{1};
    Tracked body;
    double planted_slide_m = 0; ///< most that a foot on the floor moved in the world in one step
    int most_in_the_air = 0, steps = 0;
    bool begun = false;

    Tracked const& to(Tracked const& head, double seconds = kStep_s)
    {
        Tracked const before = body;
        body = head;
        feet.step(body, world, seconds);
        int in_the_air = 0;
        for (auto const foot : {&Tracked::left_foot, &Tracked::right_foot}) {
            if (!(body.*foot)) continue;
            double const y = (body.*foot)->position.y;
            EXPECT_GE(y, 0);
            EXPECT_LT(y, 0.15);
            EXPECT_NEAR(glm::length((body.*foot)->rotation), 1, 1e-9);
            if (y > 0) ++in_the_air;
            if (!begun) continue;
            if (y == 0 && (before.*foot)->position.y == 0)
                planted_slide_m =
                    std::max(planted_slide_m, glm::distance((body.*foot)->position, (before.*foot)->position));
            if (y > 0 && (before.*foot)->position.y == 0) ++steps;
        }
        most_in_the_air = std::max(most_in_the_air, in_the_air);
        begun = true;
        return body;
    }
    /// From below the hips, m.
    double stray(dvec3 head, double yaw_rad = 0) const
    {
        Stance const s;
        dvec3 const joint = head + gi::exp_rotation({0, yaw_rad, 0}) * s.head_joint_in_head;
        auto const far = [&](RoomPose const& foot, dvec3 below) {
            dvec3 const way = foot.position - joint - gi::exp_rotation({0, yaw_rad, 0}) * below;
            return glm::length(dvec3{way.x, 0, way.z});
        };
        return std::max(far(*body.left_foot, s.left_foot), far(*body.right_foot, s.right_foot));
    }
};

TEST(Footsteps, WhoStandsAndCrouchesKeepsHisFeetWhereTheyAre)
{
    Walker w;
    Tracked const first = w.to(head_at({0.3, 1.7, -2}));
    EXPECT_LT(w.stray({0.3, 1.7, -2}), 1e-12);
    for (int i = 1; i <= 300; ++i) {
        w.to(head_at({0.3 + 0.02 * std::sin(0.1 * i), 1.7 - 0.003 * i, -2}));
        EXPECT_EQ(w.body.left_foot, first.left_foot) << i;
        EXPECT_EQ(w.body.right_foot, first.right_foot) << i;
    }
}

TEST(Footsteps, WhoWalksStepsWithOneFootAtATime)
{
    for (double const speed : {0.3, 1.0, 1.4, 2.5}) {
        Walker w;
        dvec3 head{0, 1.7, 0};
        for (int i = 0; i < 100; ++i) w.to(head_at(head));
        double farthest = 0;
        for (double const t_end = 6; head.z > -speed * t_end; head.z -= speed * kStep_s) {
            w.to(head_at(head));
            farthest = std::max(farthest, w.stray(head));
        }
        EXPECT_EQ(w.planted_slide_m, 0) << speed;
        EXPECT_EQ(w.most_in_the_air, 1) << speed;
        EXPECT_GT(w.steps, 6) << speed;
        EXPECT_LT(farthest, 0.4 + 0.12 * speed) << speed;
        for (int i = 0; i < 200; ++i) w.to(head_at(head));
        EXPECT_LT(w.stray(head), 0.031) << "who stops brings his feet together";
        Tracked const still = w.body;
        for (int i = 0; i < 100; ++i) EXPECT_EQ(w.to(head_at(head)), still);
    }
}

TEST(Footsteps, WhoTurnsTurnsHisFeet)
{
    Walker w;
    double yaw = 0;
    for (; yaw < 6.28; yaw += 0.02) w.to(head_at({0, 1.7, 0}, yaw));
    EXPECT_EQ(w.planted_slide_m, 0);
    EXPECT_GT(w.steps, 8);
    for (int i = 0; i < 200; ++i) w.to(head_at({0, 1.7, 0}, yaw));
    for (auto const foot : {w.body.left_foot, w.body.right_foot})
        EXPECT_LT(angle_between(foot->rotation, gi::exp_rotation({0, yaw, 0})), 0.15);
}

/// Between two looks nothing jumps: a swing of a metre in 0.1 s is 17 m/s in its middle.
TEST(Footsteps, FeetMoveSmoothly)
{
    Walker w;
    Tracked before = w.to(known_walk(0));
    for (int i = 1; i < 2000; ++i) {
        Tracked head;
        head.head = known_walk(0.01 * i).head;
        Tracked const now = w.to(head);
        for (auto const foot : {&Tracked::left_foot, &Tracked::right_foot}) {
            EXPECT_LT(glm::distance((now.*foot)->position, (before.*foot)->position), 0.06) << i;
            EXPECT_LT(angle_between((now.*foot)->rotation, (before.*foot)->rotation), 0.2) << i;
        }
        before = now;
    }
}

/// The room moves through the world, the head rests in it: keys walk.
TEST(Footsteps, RoomsThatMoveAreWalkedThrough)
{
    Walker w;
    gi::dmat4 const turned = glm::mat4_cast(gi::exp_rotation({0, 0.8, 0}));
    std::array<std::optional<dvec3>, 2> stood; // in the world
    for (int i = 0; i < 400; ++i) {
        w.world = turned * 2.0; // twice as large
        w.world[3] = {0.02 * i, 0.3, -0.01 * i, 1};
        w.to(head_at({0, 1.6, 0}));
        for (std::size_t f = 0; f < 2; ++f) {
            dvec3 const foot = (f == 0 ? w.body.left_foot : w.body.right_foot)->position;
            std::optional<dvec3> stands;
            if (foot.y == 0) stands = dvec3(w.world * glm::dvec4(foot, 1));
            if (stands && stood[f]) {
                EXPECT_LT(glm::distance(*stands, *stood[f]), 1e-9) << i;
            }
            stood[f] = stands;
        }
    }
    EXPECT_GT(w.steps, 8);
    EXPECT_EQ(w.most_in_the_air, 1);
}

TEST(Footsteps, JumpsAndHastePutThemBelowTheHips)
{
    Walker w;
    w.to(head_at({0, 1.7, 0}));
    w.to(head_at({5, 1.7, 3}, 2));
    EXPECT_LT(w.stray({5, 1.7, 3}, 2), 1e-12);
    EXPECT_EQ(w.body.left_foot->position.y, 0);
    dvec3 head{5, 1.7, 3};
    for (int i = 0; i < 100; ++i) w.to(head_at(head += dvec3{0.08, 0, 0}));
    EXPECT_LT(w.stray(head), 1e-12) << "8 m/s";
}

TEST(Footsteps, TrackedFeetAreKept)
{
    Walker w;
    for (int i = 0; i < 100; ++i) {
        Tracked t = head_at({0, 1.7, -0.01 * i});
        t.left_foot = RoomPose{{-0.2, 0.05, 0.4}, gi::exp_rotation({0.3, 0.2, 0})};
        w.feet.step(t, gi::dmat4(1), kStep_s);
        EXPECT_EQ(t.left_foot->position, (dvec3{-0.2, 0.05, 0.4}));
        EXPECT_TRUE(t.right_foot);
    }
    Tracked lost = head_at({0, 1.7, -1});
    w.feet.step(lost, gi::dmat4(1), 0);
    EXPECT_LT(glm::distance(lost.left_foot->position, {-0.2, 0, 0.4}), 1e-9) << "steps on from where it was seen";
    Tracked nobody;
    w.feet.step(nobody, gi::dmat4(1), kStep_s);
    EXPECT_FALSE(nobody.left_foot);
}

TEST(Footsteps, SameHeadsSameFeet)
{
    Walker a, b;
    for (int i = 0; i < 500; ++i) {
        Tracked head;
        head.head = known_walk(0.02 * i).head;
        EXPECT_EQ(a.to(head, 0.02), b.to(head, 0.02));
    }
}

} // namespace
} // namespace viewer::test
