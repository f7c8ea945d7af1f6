#pragma once
// Maps keys, mouse and gamepads to motion through the world and to commands.
//
//   W A S D, arrows   move            1 .. 9, 0  stereo modes        F1   panel
//   Q, E              down, up        V          picture, split,     F2   screenshot
//   shift, control    fast, slow                 flicker, difference F11  swap the eyes
//   drag              look around     C          compare with the    Tab  fly, walk, orbit
//   wheel             nearer, farther            reference           R    to the first camera
//   click             select          M          next method         P    reproject
//   control + drag    move selected   + -        exposure            Esc  quit
//                     object          space      play, pause
//   Z, X (held)       raise the avatar's left, right hand
//   Gamepad: left stick moves, right stick looks, triggers down and up, A selects, start plays and pauses.

#include "viewer/devices/gl/input_event.h"
#include "viewer/engine/live/navigation.h"

#include <set>
#include <string>
#include <vector>

namespace viewer {

enum class Command {
    close,
    panel,
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

/// GLFW's key code for a name ("w", "F1", "escape"); -1 if unknown.
int key_code(std::string const& name);

} // namespace viewer
