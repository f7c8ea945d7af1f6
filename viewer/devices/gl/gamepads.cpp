#include "viewer/devices/gl/gamepads.h"

#include <cmath>

namespace viewer {
namespace {

GLFWgamepadstate at_rest()
{
    GLFWgamepadstate state{};
    state.axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER] = state.axes[GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER] = -1;
    return state;
}

} // namespace

void gamepad_changes(int device, std::optional<GLFWgamepadstate> const& before,
                     std::optional<GLFWgamepadstate> const& now, InputEvent::Clock::time_point time,
                     std::vector<InputEvent>& out)
{
    GLFWgamepadstate const was = before.value_or(at_rest()), is = now.value_or(at_rest());
    InputEvent event;
    event.window = -1;
    event.device = device;
    event.time = time;
    for (int k = 0; k <= GLFW_GAMEPAD_BUTTON_LAST; ++k) {
        if (was.buttons[k] == is.buttons[k]) continue;
        event.kind = InputKind::gamepad_button;
        event.code = k;
        event.action = is.buttons[k] == GLFW_PRESS ? InputAction::press : InputAction::release;
        out.push_back(event);
    }
    event.action = InputAction::press;
    for (int k = 0; k <= GLFW_GAMEPAD_AXIS_LAST; ++k) {
        if (was.axes[k] == is.axes[k]) continue;
        event.kind = InputKind::gamepad_axis;
        event.code = k;
        event.x = double(is.axes[k]);
        out.push_back(event);
    }
}

void Gamepads::poll(std::vector<InputEvent>& out)
{
    auto const time = InputEvent::Clock::now();
    for (int device = 0; device <= GLFW_JOYSTICK_LAST; ++device) {
        auto& last = states_[std::size_t(device)];
        std::optional<GLFWgamepadstate> now;
        if (GLFWgamepadstate state; glfwJoystickIsGamepad(device) && glfwGetGamepadState(device, &state))
            now = state;
        if (!now && !last) continue;
        if (now && last) // an axis that hardly moved keeps its last value, so that noise does not accumulate
            for (int k = 0; k <= GLFW_GAMEPAD_AXIS_LAST; ++k)
                if (std::abs(now->axes[k] - last->axes[k]) < kAxisStep) now->axes[k] = last->axes[k];
        gamepad_changes(device, last, now, time, out);
        last = now;
    }
}

} // namespace viewer
