#pragma once
// What the buttons and joystick of a wand do: a tracked pointing device with buttons (an ART flystick, a VRPN or
// OSC wand). Plain data of a display file.

#include <optional>
#include <string>
#include <vector>

namespace viewer {

/// What a button does when it is pressed; from `forward` on: while it is held.
enum class WandAction {
    none,
    select, ///< what the wand points at: an object, or an entry of the menu
    menu,   ///< opens and closes the panel on the wall that the wand points at
    navigation,
    first_camera,
    play,
    screenshot,
    next_method,
    brighter,
    darker,
    forward, ///< where the wand points
    backward,
    left,
    right,
    up,
    down,
    turn_left,
    turn_right
};

/// Motion by an axis: `right` and `forward` relative to where the wand points, `up` in the room.
enum class WandMotion { none, right, forward, up, turn_right };

struct WandAxis {
    WandMotion motion = WandMotion::none;
    bool reversed = false;

    bool operator==(WandAxis const&) const = default;
};

struct WandSettings {
    std::vector<WandAction> buttons{WandAction::select, WandAction::menu, WandAction::navigation,
                                    WandAction::first_camera};                                 ///< by number
    std::vector<WandAxis> axes{{WandMotion::turn_right, false}, {WandMotion::forward, false}}; ///< by number

    bool operator==(WandSettings const&) const = default;
};

inline constexpr std::size_t kMostWandButtons = 32;
inline constexpr std::size_t kMostWandAxes = 16;

/// Words of display files; empty if there is none of this name. Reversed axes begin with "-": "-forward".
char const* name_of(WandAction action);
std::optional<WandAction> wand_action(std::string const& name);
std::string wand_action_names();
std::string name_of(WandAxis const& axis);
std::optional<WandAxis> wand_axis(std::string const& name);
std::string wand_axis_names();

} // namespace viewer
