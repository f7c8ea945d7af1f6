// Commands from the buttons and axes of a wand.

#include "viewer/app/wand_input.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

WandState wand(std::uint32_t buttons, std::vector<double> axes = {}, double yaw_deg = 0, double pitch_deg = 0)
{
    gi::dquat const turned = glm::angleAxis(glm::radians(yaw_deg), gi::dvec3{0, 1, 0}) *
                             glm::angleAxis(glm::radians(pitch_deg), gi::dvec3{1, 0, 0});
    return {RoomPose{{0, 1, 0}, turned}, true, buttons, std::move(axes)};
}

TEST(WandInput, ButtonsActOnceWhenPressed)
{
    WandInput input{WandSettings{}};
    EXPECT_EQ(input.step(wand(0b0011), 0.01).pressed, (std::vector{WandAction::select, WandAction::menu}));
    WandStep const held = input.step(wand(0b0011), 0.01);
    EXPECT_TRUE(held.pressed.empty());
    EXPECT_TRUE(held.selects);
    EXPECT_FALSE(input.step(wand(0b0010), 0.01).selects);
    EXPECT_EQ(input.step(wand(0b1110), 0.01).pressed,
              (std::vector{WandAction::navigation, WandAction::first_camera}));
    EXPECT_TRUE(input.step(wand(0x80000000u), 0.01).pressed.empty()) << "without a meaning";
}

TEST(WandInput, MovesWhereItPoints)
{
    WandInput input{WandSettings{}};
    struct {
        double yaw, pitch;
        gi::dvec3 way; ///< right, up, forward of the room
    } const cases[] = {{0, 0, {0, 0, 1}}, {-90, 0, {1, 0, 0}}, {180, 0, {0, 0, -1}}, {0, 90, {0, 1, 0}}};
    for (auto const& c : cases) {
        NavigationInput const m = input.step(wand(0, {0, 1}, c.yaw, c.pitch), 0.01).motion;
        EXPECT_LT(glm::distance(gi::dvec3(m.right, m.up, m.forward), c.way), 1e-12) << c.yaw << " " << c.pitch;
    }
    WandStep const turning = input.step(wand(0, {-1, 0.1}), 0.02);
    EXPECT_NEAR(turning.motion.turn_right_rad, -0.03, 1e-12);
    EXPECT_EQ(turning.motion.forward, 0) << "in the dead zone";
    EXPECT_NEAR(input.step(wand(0, {0, 7}), 0.01).motion.forward, 1, 1e-12) << "no faster than full";
}

TEST(WandInput, HeldButtonsAndReversedAxesMove)
{
    WandInput input{WandSettings{{WandAction::backward, WandAction::left, WandAction::turn_left, WandAction::up},
                                 {{WandMotion::forward, true}, {WandMotion::none, false}}}};
    for (int k = 0; k < 2; ++k) {
        NavigationInput const m = input.step(wand(0b1111), 0.01).motion;
        EXPECT_NEAR(m.forward, -1, 1e-12);
        EXPECT_NEAR(m.right, -1, 1e-12);
        EXPECT_NEAR(m.up, 1, 1e-12);
        EXPECT_NEAR(m.turn_right_rad, -0.015, 1e-12);
    }
    EXPECT_NEAR(input.step(wand(0, {0.5, 1}), 0.01).motion.forward, -0.5, 1e-12);
}

TEST(WandInput, AWandThatIsNotSeenMovesNobody)
{
    WandInput input{WandSettings{{WandAction::forward, WandAction::play}, {{WandMotion::forward, false}}}};
    WandState lost = wand(0b11, {1});
    EXPECT_GT(input.step(lost, 0.01).motion.forward, 0);
    lost.fresh = false;
    WandStep const held = input.step(lost, 0.01);
    EXPECT_EQ(held.motion.forward, 0);
    lost.fresh = true;
    EXPECT_EQ(input.step(lost, 0.01).pressed, std::vector{WandAction::play}) << "released while it was away";
    WandState blind = wand(0b10);
    blind.pose.reset();
    blind.fresh = false;
    WandInput other{WandSettings{{WandAction::forward, WandAction::play}, {}}};
    EXPECT_EQ(other.step(blind, 0.01).pressed, std::vector{WandAction::play}) << "a device without poses";
}

} // namespace
} // namespace viewer::test
