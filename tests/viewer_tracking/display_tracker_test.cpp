#include "viewer/devices/tracking/display_tracker.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

TEST(DisplayTracker, ANameThatIsGivenIsNoOthersByDefault)
{
    DisplayTracker t;
    t.type = DisplayTrackerType::osc;
    t.body = "/head";
    TrackerSettings const plain = tracker_settings(t);
    ASSERT_FALSE(plain.right_hand.id.empty());
    t.left_foot_body = "/" + plain.right_hand.id; // the marker of a hand is worn on a foot
    TrackerSettings const s = tracker_settings(t);
    EXPECT_EQ(s.left_foot.id, plain.right_hand.id);
    EXPECT_TRUE(s.right_hand.id.empty());
    EXPECT_EQ(s.left_hand.id, plain.left_hand.id);
    t.left_hand_body = "/" + plain.right_hand.id;
    t.right_hand_body = "/" + plain.left_hand.id; // both say so: swapped
    t.left_foot_body.clear();
    EXPECT_EQ(tracker_settings(t).left_hand.id, plain.right_hand.id);
    EXPECT_EQ(tracker_settings(t).right_hand.id, plain.left_hand.id);
}

} // namespace
} // namespace viewer::test
