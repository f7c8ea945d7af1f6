#pragma once
// Maps keys, mouse and gamepads to motion through the world and to commands.
// key_meanings() is the table of all keys.

#include "viewer/devices/gl/input_event.h"
#include "viewer/engine/live/navigation.h"

#include <set>
#include <span>
#include <string>
#include <vector>

namespace viewer {

enum class Command {
    close,
    panel,
    help,
    open_scene,
    hold_exposure,
    headlight,
    screenshot,
    swap_eyes,
    next_navigation,
    first_camera,
    next_view,
    compare,
    next_method,
    brighter,
    darker,
    play,
    reproject,
    select, ///< at (x, y)
    drag    ///< moves the selected object by (x, y)
};

struct CommandEvent {
    Command command;
    double x = 0, y = 0; ///< px from the window's top left corner
    int window = 0;
};

class Controls {
public:
    /// @param height_px  of the window: a drag over this length turns by 90 degrees
    void take(InputEvent const& event, double height_px);
    /// Commands since the last call.
    NavigationInput motion(double seconds);
    std::vector<CommandEvent> commands();
    /// Number of the stereo mode chosen since the last call; -1 = none.
    int stereo_mode();
    /// True while the key that raises the avatar's hand is held.
    bool raises_left() const;
    bool raises_right() const;
    /// Releases all keys, because the window lost its focus.
    void release_all();

private:
    void key(InputEvent const& e);
    void mouse(InputEvent const& e, double height_px);

    std::set<int> held_;
    std::vector<CommandEvent> commands_;
    double axes_[6] = {}; ///< axes of the gamepad
    double turn_right_ = 0, turn_up_ = 0, closer_ = 0;
    double mouse_x_ = 0, mouse_y_ = 0, moved_px_ = 0;
    bool dragging_ = false, moving_object_ = false;
    int stereo_mode_ = -1;
};

/// An axis of a stick; 0 in its dead zone, where it rests.
double live(double axis);

/// What a key or a movement of the mouse does, for people: the help overlay,
/// `lightwell view --help`, docs/viewer.md.
struct KeyMeaning {
    char const* keys;    ///< "W A S D, arrows"
    char const* meaning; ///< "move"
};
std::span<KeyMeaning const> key_meanings();

/// GLFW's key code for a name ("w", "F1", "escape"); -1 if unknown.
int key_code(std::string const& name);

} // namespace viewer
