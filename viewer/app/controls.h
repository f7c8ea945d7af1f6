#pragma once
// What keys, mouse and gamepads mean: motion through the world, and commands.
//
//   W A S D, arrows   move            1 .. 9, 0  stereo modes        F1   panel
//   Q, E              down, up        V          picture, split,     F2   screenshot
//   shift, control    fast, slow                 flicker, difference F11  swap the eyes
//   drag              look around     C          compare with the    Tab  fly, walk, orbit
//   wheel             nearer, farther            reference           R    to the first camera
//   click             select          M          next method         P    reproject
//   control + drag    move what is    + -        exposure            Esc  end
//                     selected        space      play, pause
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
    drag    ///< what is selected, by (x, y)
};

struct CommandEvent {
    Command command;
    double x = 0, y = 0; ///< px in the window, from its top left corner
    int window = 0;
};

class Controls {
public:
    /// @param height_px  of the window: a drag over all of it turns by a right angle
    void take(InputEvent const& event, double height_px);
    /// What was done since the last call.
    NavigationInput motion(double seconds);
    std::vector<CommandEvent> commands();
    /// A stereo mode by number, -1 = none was asked for since the last call.
    int stereo_mode();
    /// The key that raises a hand of the avatar is held.
    bool raises_left() const;
    bool raises_right() const;
    /// All keys are up: the window has lost its focus.
    void release_all();

private:
    void key(InputEvent const& e);
    void mouse(InputEvent const& e, double height_px);

    std::set<int> held_;
    std::vector<CommandEvent> commands_;
    double axes_[6] = {}; ///< of the gamepad
    double turn_right_ = 0, turn_up_ = 0, closer_ = 0;
    double mouse_x_ = 0, mouse_y_ = 0, moved_px_ = 0;
    bool dragging_ = false, moving_object_ = false;
    int stereo_mode_ = -1;
};

/// GLFW's code of a key by its name ("w", "F1", "escape"); -1 = there is none.
int key_code(std::string const& name);

} // namespace viewer
