#pragma once
// What is wrong with a display, whatever it was read from.

#include "gi/core/report.h"
#include "viewer/displays/display.h"

namespace viewer {

/// Outside of these nobody's eyes are (Dodgson 2004: 0.045 to 0.080 m for adults, children from 0.040 m), and
/// outside of the others few people's.
inline constexpr double kNarrowestEyes_m = 0.04, kWidestEyes_m = 0.08;
inline constexpr double kFewNarrower_m = 0.05, kFewWider_m = 0.075;
inline constexpr int kLargestWindow_px = 32768;
inline constexpr std::size_t kMostWalls = 256;

/// The first fault: in which list and which entry of it ("" and 0 = the display as a whole), at which key of a
/// display file, and what to say of it.
struct DisplayFault {
    std::string list;
    std::size_t index = 0;
    std::string key;
    std::string problem, why, suggestion;
};
std::optional<DisplayFault> find_fault(Display const& display);
/// Throws InputError with the fault, if there is one; `file` is named.
void require_sound(Display const& display, std::string const& file);
/// Counts what works but is probably not meant: unusual eyes, idle windows, crooked walls, bands of blending that
/// do not fit the overlap of their walls.
void report_doubts(Display const& display, gi::Report& report);

} // namespace viewer
