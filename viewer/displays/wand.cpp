#include "viewer/displays/wand.h"

#include <iterator>
#include <utility>

namespace viewer {
namespace {

constexpr char const* kActions[] = {"none",    "select",     "menu",        "navigation", "first_camera",
                                    "play",    "screenshot", "next_method", "brighter",   "darker",
                                    "forward", "backward",   "left",        "right",      "up",
                                    "down",    "turn_left",  "turn_right"};
static_assert(std::size(kActions) == std::size_t(WandAction::turn_right) + 1);

constexpr char const* kMotions[] = {"none", "right", "forward", "up", "turn_right"};
static_assert(std::size(kMotions) == std::size_t(WandMotion::turn_right) + 1);

template <std::size_t n>
std::string joined(char const* const (&names)[n])
{
    std::string text;
    for (char const* name : names) text += (text.empty() ? "" : ", ") + std::string(name);
    return text;
}

} // namespace

char const* name_of(WandAction action) { return kActions[std::size_t(action)]; }

std::optional<WandAction> wand_action(std::string const& name)
{
    for (std::size_t k = 0; k < std::size(kActions); ++k)
        if (name == kActions[k]) return WandAction(k);
    return {};
}

std::string wand_action_names() { return joined(kActions); }

std::string name_of(WandAxis const& axis)
{
    return (axis.reversed ? "-" : "") + std::string(kMotions[std::size_t(axis.motion)]);
}

std::optional<WandAxis> wand_axis(std::string const& name)
{
    bool const reversed = name.starts_with('-');
    for (std::size_t k = 0; k < std::size(kMotions); ++k)
        if (name.substr(reversed ? 1 : 0) == kMotions[k]) return WandAxis{WandMotion(k), reversed};
    return {};
}

std::string wand_axis_names() { return joined(kMotions) + ", each with - before it for the reverse"; }

} // namespace viewer
