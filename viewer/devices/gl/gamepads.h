#pragma once
// Gamepads with GLFW's mapping (SDL's): all models use the same names for axes and buttons.

#include "viewer/devices/gl/input_event.h"

#include <GLFW/glfw3.h>
#include <array>
#include <optional>
#include <vector>

namespace viewer {

/// Gamepads are polled; events are the differences. Smaller motions of an axis are ignored.
inline constexpr float kAxisStep = 1.0f / 256;

/// Appends the changes of gamepad `device` between two states. A newly connected gamepad starts from rest; on
/// disconnection all held buttons are released.
void gamepad_changes(int device, std::optional<GLFWgamepadstate> const& before,
                     std::optional<GLFWgamepadstate> const& now, InputEvent::Clock::time_point time,
                     std::vector<InputEvent>& out);

class Gamepads {
public:
    /// Polls GLFW, which must be running, and appends the changes since the last call.
    void poll(std::vector<InputEvent>& out);

private:
    std::array<std::optional<GLFWgamepadstate>, GLFW_JOYSTICK_LAST + 1> states_;
};

} // namespace viewer
