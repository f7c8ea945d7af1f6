#include "viewer/app/wand_input.h"

#include "viewer/app/controls.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

constexpr double kTurn_rad_s = 1.5; ///< full deflection, as a gamepad's stick
/// Motion in the wand's terms.
struct Wish {
    double right = 0, up = 0, forward = 0, turn_right = 0;
};

void add_held(WandAction action, Wish& wish)
{
    wish.forward += double(action == WandAction::forward) - double(action == WandAction::backward);
    wish.right += double(action == WandAction::right) - double(action == WandAction::left);
    wish.up += double(action == WandAction::up) - double(action == WandAction::down);
    wish.turn_right += double(action == WandAction::turn_right) - double(action == WandAction::turn_left);
}

void add_axis(WandMotion motion, double value, Wish& wish)
{
    if (motion == WandMotion::forward) wish.forward += value;
    if (motion == WandMotion::right) wish.right += value;
    if (motion == WandMotion::up) wish.up += value;
    if (motion == WandMotion::turn_right) wish.turn_right += value;
}

} // namespace

WandStep WandInput::step(WandState const& now, double seconds)
{
    WandStep step;
    std::uint32_t const down = now.fresh || !now.pose ? now.buttons : 0;
    Wish wish;
    for (std::size_t k = 0; k < settings_.buttons.size(); ++k) {
        std::uint32_t const bit = 1u << k;
        if ((down & bit) == 0) continue;
        WandAction const action = settings_.buttons[k];
        step.selects |= action == WandAction::select;
        if ((held_ & bit) == 0 && action < WandAction::forward && action != WandAction::none)
            step.pressed.push_back(action);
        add_held(action, wish);
    }
    held_ = down;
    for (std::size_t k = 0; k < std::min(settings_.axes.size(), now.axes.size()); ++k) {
        WandAxis const& axis = settings_.axes[k];
        add_axis(axis.motion, live(std::clamp(axis.reversed ? -now.axes[k] : now.axes[k], -1.0, 1.0)), wish);
    }
    if (!now.fresh || !now.pose) return step; // a wand that is not seen moves nobody
    step.scroll = wish.forward;
    gi::dvec3 const ahead = now.pose->rotation * gi::dvec3{0, 0, -1};
    // To its right on the level, however it is rolled; none while it points straight up or down.
    gi::dvec3 const level{-ahead.z, 0, ahead.x};
    double const length = glm::length(level);
    gi::dvec3 const right = length > 1e-3 ? level / length : gi::dvec3{0};
    gi::dvec3 const way = wish.forward * ahead + wish.right * right + gi::dvec3{0, wish.up, 0};
    step.motion.right = way.x;
    step.motion.up = way.y;
    step.motion.forward = -way.z;
    step.motion.turn_right_rad = wish.turn_right * kTurn_rad_s * seconds;
    return step;
}

} // namespace viewer
