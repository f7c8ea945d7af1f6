#include "viewer/devices/gl/gamepads.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

GLFWgamepadstate at_rest()
{
    GLFWgamepadstate state{};
    state.axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER] = state.axes[GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER] = -1;
    return state;
}

TEST(Gamepads, EventsAreWhatChanged)
{
    GLFWgamepadstate now = at_rest();
    now.buttons[GLFW_GAMEPAD_BUTTON_B] = GLFW_PRESS;
    now.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y] = -0.5f;
    std::vector<InputEvent> events;
    gamepad_changes(3, at_rest(), now, {}, events);
    ASSERT_EQ(events.size(), 2u);
    EXPECT_EQ(events[0].kind, InputKind::gamepad_button);
    EXPECT_EQ(events[0].code, GLFW_GAMEPAD_BUTTON_B);
    EXPECT_EQ(events[0].action, InputAction::press);
    EXPECT_EQ(events[1].kind, InputKind::gamepad_axis);
    EXPECT_EQ(events[1].code, GLFW_GAMEPAD_AXIS_RIGHT_Y);
    EXPECT_EQ(events[1].x, -0.5);
    EXPECT_EQ(events[1].device, 3);
}

TEST(Gamepads, PluggedInAtRestSaysNothing)
{
    std::vector<InputEvent> events;
    gamepad_changes(0, std::nullopt, at_rest(), {}, events);
    EXPECT_TRUE(events.empty());
}

TEST(Gamepads, PulledOutLetsGo)
{
    GLFWgamepadstate held = at_rest();
    held.buttons[GLFW_GAMEPAD_BUTTON_A] = GLFW_PRESS;
    held.axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER] = 1;
    std::vector<InputEvent> events;
    gamepad_changes(0, held, std::nullopt, {}, events);
    ASSERT_EQ(events.size(), 2u);
    EXPECT_EQ(events[0].action, InputAction::release);
    EXPECT_EQ(events[1].x, -1.0);
}

} // namespace
} // namespace viewer::test
