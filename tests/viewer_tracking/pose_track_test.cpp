// One body: prediction, order, dropouts, recovery.

#include "gi/core/pose.h"
#include "tests/viewer_tracking/pose_checks.h"
#include "viewer/devices/tracking/known_walk.h"
#include "viewer/devices/tracking/pose_track.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

namespace viewer::test {
namespace {

RoomPose moving(double t) { return {{0.8 * t, 1.7, -0.3 * t}, gi::exp_rotation({0, 0.9 * t, 0})}; }

PoseTrack moved(double seconds)
{
    PoseTrack track;
    for (int i = 0; i <= int(seconds * 60); ++i) track.add(i / 60.0, moving(i / 60.0), i / 60.0);
    return track;
}

TEST(PoseTrack, PredictsConstantMotionExactly)
{
    PoseTrack const track = moved(4);
    for (double const ahead : {0.0, 0.013, 0.05, 0.1}) {
        TrackedPose const p = track.at(4 + ahead);
        ASSERT_EQ(p.state, TrackState::tracked);
        EXPECT_LT(glm::distance(p.pose->position, moving(4 + ahead).position), 1e-6) << ahead;
        EXPECT_LT(angle_between(p.pose->rotation, moving(4 + ahead).rotation), 1e-6) << ahead;
    }
    EXPECT_LT(glm::distance(track.at(3.712).pose->position, moving(3.712).position), 1e-6) << "also the past";
}

TEST(PoseTrack, PredictionIsLimited)
{
    PoseTrack const track = moved(4);
    double const speed = glm::length(gi::dvec3(0.8, 0, -0.3));
    gi::dvec3 const held = track.at(4.5).pose->position;
    EXPECT_NEAR(glm::distance(held, moving(4).position), speed * 0.15, 1e-6) << "1.5 horizons";
    EXPECT_EQ(track.at(4.9).pose->position, held);
    EXPECT_EQ(track.at(4.19).state, TrackState::tracked);
    EXPECT_EQ(track.at(4.21).state, TrackState::held);
    EXPECT_EQ(track.at(5.01).state, TrackState::lost);
    EXPECT_FALSE(track.at(5.01).pose);
    EXPECT_NEAR(track.at(5.01).age_s, 1.01, 1e-9);
    EXPECT_EQ(PoseTrack().at(0).state, TrackState::never);
    // No jerk on the way: steps of 1 ms never longer than at full speed.
    for (int i = 0; i < 500; ++i)
        EXPECT_LT(
            glm::distance(track.at(4 + i * 0.001).pose->position, track.at(4.001 + i * 0.001).pose->position),
            speed * 0.001 + 1e-9);
}

TEST(PoseTrack, OrderOfArrivalDoesNotMatter)
{
    std::vector<double> times;
    for (int i = 0; i < 40; ++i) times.push_back(i / 60.0);
    PredictionSettings at_once;
    at_once.smooth_s = 0;
    PoseTrack in_order({}, at_once), shuffled({}, at_once);
    for (double const t : times) in_order.add(t, *known_walk(t).head, t);
    std::mt19937 rng(5);
    for (std::size_t i = 0; i + 4 <= times.size(); i += 4)
        std::shuffle(times.begin() + long(i), times.begin() + long(i) + 4, rng);
    for (double const t : times) shuffled.add(t, *known_walk(t).head, t);
    EXPECT_GT(shuffled.counts().late, 5u);
    EXPECT_EQ(shuffled.counts().too_late, 0u);
    for (double const t : {0.2, 0.64, 0.7}) EXPECT_EQ(*in_order.at(t).pose, *shuffled.at(t).pose);
}

TEST(PoseTrack, CorrectionsAreTakenOverSmoothly)
{
    PoseTrack track = moved(4);
    RoomPose const before = *track.at(4.05).pose;
    track.add(4.05, {{4.05 * 0.8, 1.8, -0.3 * 4.05}, before.rotation}, 4.05); // 10 cm up
    EXPECT_LT(glm::distance(track.at(4.05).pose->position, before.position), 1e-9) << "no jump when it comes";
    EXPECT_GT(track.at(4.11).pose->position.y, 1.71) << "but soon";
}

TEST(PoseTrack, TooLateIsCounted)
{
    PoseTrack track = moved(4);
    track.add(0.5, moving(0.5), 4);
    EXPECT_EQ(track.counts().too_late, 1u);
    EXPECT_LT(glm::distance(track.at(4).pose->position, moving(4).position), 1e-6);
}

TEST(PoseTrack, RecoveryIsSmooth)
{
    PoseTrack track = moved(4);
    gi::dvec3 const held = track.at(4.6).pose->position;
    for (int i = 0; i <= 60; ++i) {
        double const t = 4.6 + i / 60.0;
        track.add(t, {{10, 1, 0}, {1, 0, 0, 0}}, t);
        double const from_held = glm::distance(track.at(t).pose->position, held);
        if (i == 0) {
            EXPECT_LT(from_held, 1e-9) << "begins where it was held";
        } else if (t > 4.81) {
            EXPECT_LT(glm::distance(track.at(t).pose->position, {10, 1, 0}), 1e-9);
        }
    }
    EXPECT_EQ(track.counts().dropouts, 1u);
    // Never faster than smoothstep allows: 1.5 times the way in 0.2 s.
    double const way = glm::distance(held, gi::dvec3(10, 1, 0));
    PoseTrack again = moved(4);
    again.add(4.6, {{10, 1, 0}, {1, 0, 0, 0}}, 4.6);
    for (int i = 0; i < 150; ++i) {
        double const t = 4.6 + i * 0.001;
        EXPECT_LT(glm::distance(again.at(t).pose->position, again.at(t + 0.001).pose->position),
                  1.51 * way / 0.2 * 0.001);
    }
}

TEST(PoseTrack, NonsenseIsNotTaken)
{
    PoseTrack track;
    track.add(0, {{NAN, 0, 0}, {1, 0, 0, 0}}, 0);
    track.add(INFINITY, {}, 0);
    EXPECT_EQ(track.at(0).state, TrackState::never);
}

} // namespace
} // namespace viewer::test
