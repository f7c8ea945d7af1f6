#pragma once
// Gamepads by GLFW's mapping (that of SDL): every model has the axes and buttons of the same names.

#include "viewer/devices/gl/input_event.h"

#include <GLFW/glfw3.h>
#include <array>
#include <optional>
#include <vector>

namespace viewer {

/// What a gamepad does is polled; events are the differences. An axis that moved less than this is still.
inline constexpr float kAxisStep = 1.0f / 256;

/// Appends what changed on gamepad `device` between two states. One that is plugged in starts from rest; what is
/// held on one that is pulled out is let go.
void gamepad_changes(int device, std::optional<GLFWgamepadstate> const& before,
                     std::optional<GLFWgamepadstate> const& now, InputEvent::Clock::time_point time,
                     std::vector<InputEvent>& out);

class Gamepads {
public:
    /// Asks GLFW, which must run, and appends what changed since the last call.
    void poll(std::vector<InputEvent>& out);

private:
    std::array<std::optional<GLFWgamepadstate>, GLFW_JOYSTICK_LAST + 1> states_;
};

} // namespace viewer
