#pragma once
// What the importers share.

#include "gi/core/report.h"
#include "viewer/displays/display.h"

#include <string>
#include <vector>

namespace viewer {

/// Eyes as far apart as the file says, or 0.063 m, counted, where that is nobody's.
double imported_eyes(double metres, std::string const& where, gi::Report& report);
inline constexpr std::size_t kMostImportedParts = 1000;
/// `wanted`, or with a number behind it, so that no other part has it. Throws InputError where there are too many.
template <typename Part>
std::string free_name(std::vector<Part> const& parts, std::string const& wanted)
{
    if (parts.size() >= kMostImportedParts)
        throw gi::InputError("more than 1000 windows or walls", "no room has so many", "is it one display?");
    auto const is_taken = [&](std::string const& name) {
        for (Part const& part : parts)
            if (part.name == name) return true;
        return false;
    };
    std::string name = wanted;
    for (int n = 2; is_taken(name); ++n) name = wanted + " " + std::to_string(n);
    return name;
}
/// From the lower left corner of the window, fractions of its size, to ours.
Viewport from_below(double x, double y, double width, double height);
/// Says that there is nothing to draw on, or checks the display and counts doubts.
Display finished(Display display, std::string const& file, gi::Report& report);

} // namespace viewer
