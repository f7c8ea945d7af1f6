// Axes, units and the tracker's place in the room.

#include "gi/core/pose.h"
#include "viewer/devices/tracking/fake_tracker.h"
#include "viewer/devices/tracking/tracker_to_room.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

/// right, up and forward of a person in a tracker's axes.
struct Convention {
    TrackerAxes axes;
    gi::dvec3 right, up, forward;
};

Convention const kConventions[] = {
    {TrackerAxes::y_up, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
    {TrackerAxes::z_up, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
    {TrackerAxes::left_handed_y_up, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {TrackerAxes::left_handed_z_up, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
};

TEST(TrackerToRoom, PlacesAndTurnsMeanTheSameInAllAxes)
{
    for (Convention const& c : kConventions) {
        SCOPED_TRACE(int(c.axes));
        TrackerToRoom t;
        t.axes = c.axes;
        // 1 to the right, 2 up, 3 ahead.
        gi::dvec3 const place = 1.0 * c.right + 2.0 * c.up + 3.0 * c.forward;
        EXPECT_LT(glm::distance(to_room(t, {place, {1, 0, 0, 0}}).position, {1, 2, -3}), 1e-12);
        // A person who turns to look right. In the tracker's own algebra that takes forward to right.
        double const handed = glm::dot(glm::cross(c.right, c.up), c.forward); // -1: right-handed
        gi::dquat const turn = gi::exp_rotation(c.up * (handed * 0.5 * 3.14159265358979));
        EXPECT_LT(glm::distance(turn * c.forward, c.right), 1e-9) << "the test's own turn";
        gi::dquat const room = to_room(t, {place, turn}).rotation;
        EXPECT_LT(glm::distance(room * gi::dvec3(0, 0, -1), {1, 0, 0}), 1e-9);
        EXPECT_LT(glm::distance(room * gi::dvec3(0, 1, 0), {0, 1, 0}), 1e-9);
        // And looks up.
        gi::dquat const up = gi::exp_rotation(c.right * (-handed * 0.5 * 3.14159265358979));
        EXPECT_LT(glm::distance(up * c.forward, c.up), 1e-9) << "the test's own turn";
        EXPECT_LT(glm::distance(to_room(t, {place, up}).rotation * gi::dvec3(0, 0, -1), {0, 1, 0}), 1e-9);
    }
}

TEST(TrackerToRoom, TransformIsAppliedOnceAfterAxesAndUnits)
{
    TrackerToRoom t;
    t.axes = TrackerAxes::z_up;
    t.metres_per_unit = 0.01;
    t.room_from_tracker = {{5, 0, 0},
                           gi::exp_rotation({0, 0.5 * 3.14159265358979, 0})}; // its forward is the room's -x
    RoomPose const p = to_room(t, {{0, 100, 170}, {1, 0, 0, 0}});             // 1 m ahead, 1.7 m up
    EXPECT_LT(glm::distance(p.position, {4, 1.7, 0}), 1e-9);
    EXPECT_LT(glm::distance(p.rotation * gi::dvec3(0, 0, -1), {-1, 0, 0}), 1e-9);
    RoomPose const eyes = to_room(t, {{0, 100, 170}, {1, 0, 0, 0}}, {{0, -0.1, -0.05}, {1, 0, 0, 0}});
    EXPECT_LT(glm::distance(eyes.position, {3.95, 1.6, 0}), 1e-9) << "10 cm below and 5 cm ahead of the marker";
}

TEST(FakeTracker, StandsStill)
{
    FakeTracker tracker;
    std::vector<TrackerSample> got;
    tracker.poll(1, got);
    tracker.poll(1.1, got);
    ASSERT_EQ(got.size(), 6u);
    EXPECT_EQ(tracker.counts().samples, 6u);
    EXPECT_EQ(got[3].pose.position, gi::dvec3(0, 1.7, 0));
    EXPECT_EQ(got[3].received_s, 1.1);
    EXPECT_EQ(got[5].body, "right_hand");
}

} // namespace
} // namespace viewer::test
