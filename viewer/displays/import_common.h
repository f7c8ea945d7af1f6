#pragma once
// Helpers shared by the importers.

#include "gi/core/error.h"
#include "viewer/displays/import.h"

#include <string>
#include <vector>

namespace viewer {

/// The file's distance between the eyes, or 0.063 m (reported) if no person has that distance.
double imported_eyes(double metres, std::string const& where, ImportLog const& log);
/// Places the eyes of a user whose head is at `user.head.translation_m`. Ours lie along the head's x axis, so the resting
/// head is turned for others: eyes at different heights keep them, until a tracker gives the head's pose.
/// @param left,right  from the head's translation, in the room's directions, m
void place_eyes(User& user, gi::dvec3 left, gi::dvec3 right, std::string const& where, ImportLog const& log);
/// Counts the address of a machine that is not this one: ours are given when a cluster is started.
void lose_address(std::string const& address, std::string const& where, ImportLog const& log);
inline constexpr std::size_t kMostImportedParts = 1000;
/// `wanted`, with a number appended if another part has this name. Throws InputError if there are too many parts.
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
/// Converts a viewport given from the window's lower left corner, in fractions of its size, to ours.
Viewport from_below(double x, double y, double width, double height);
/// Validates the imported display and reports doubtful values. Throws InputError if it has no walls, naming what
/// was skipped, or is invalid.
Display finished(Display display, std::string const& file, ImportLog const& log);

} // namespace viewer
