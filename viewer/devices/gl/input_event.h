#pragma once
// Input events of a window as plain values: keys, mouse, gamepads, and events of the window itself.

#include <chrono>
#include <cstdint>
#include <string>

namespace viewer {

enum class InputKind : std::uint8_t {
    key,            ///< code: GLFW_KEY_*, scan code, action, modifiers
    character,      ///< code: Unicode, after the keyboard layout
    mouse_move,     ///< x, y: px from the window's top left corner
    mouse_button,   ///< code: GLFW_MOUSE_BUTTON_*, action, modifiers, x, y
    scroll,         ///< x, y: steps to the right and up
    resize,         ///< x, y: px of the framebuffer
    move,           ///< x, y: of the window's content on the screen, px
    focus,          ///< action: press = gained, release = lost
    close,          ///< the user wants to close the window; it stays open until it is destroyed
    gamepad_axis,   ///< device, code: GLFW_GAMEPAD_AXIS_*, x: -1..1 (triggers: -1 = released)
    gamepad_button, ///< device, code: GLFW_GAMEPAD_BUTTON_*, action
    drop,           ///< text: the path of a file that the user dropped on the window
    hand_button,    ///< of a headset; device: 0 left, 1 right, code: 0 select, 1 trigger, 2 menu, action
};

enum class InputAction : std::uint8_t { release, press, repeat };
/// True if the panel used the event, which is then not meant for the scene.
enum class InputFor : std::uint8_t { scene, panel };

struct InputEvent {
    using Clock = std::chrono::steady_clock;

    InputKind kind = InputKind::key;
    InputAction action = InputAction::press;
    InputFor meant_for = InputFor::scene;
    int window = 0; ///< Window::number(); -1 for gamepads, which have none
    int device = 0; ///< gamepad: 0..15
    int code = 0;
    int scan_code = 0;
    int modifiers = 0; ///< GLFW_MOD_*
    double x = 0, y = 0;
    std::string text{};
    Clock::time_point time; ///< time of polling, because GLFW gives no event times
};

} // namespace viewer
