#pragma once
// Validation of a display, from any source.

#include "gi/core/report.h"
#include "viewer/displays/display.h"

namespace viewer {

/// Limits of the interpupillary distance: no person is outside the first two (Dodgson 2004: 0.045 to 0.080 m for
/// adults, children from 0.040 m), few people are outside the other two.
inline constexpr double kNarrowestEyes_m = 0.04, kWidestEyes_m = 0.08;
inline constexpr double kFewNarrower_m = 0.05, kFewWider_m = 0.075;
inline constexpr int kLargestWindow_px = 32768;
inline constexpr std::size_t kMostWalls = 256;

/// A fault: the list and the index in it ("" and 0 = the display as a whole), the key in a display file, and the
/// parts of the message.
struct DisplayFault {
    std::string list;
    std::size_t index = 0;
    std::string key;
    std::string problem, why, suggestion;
};
std::optional<DisplayFault> find_fault(Display const& display);
/// Throws InputError with the first fault, if any; the message names `file`.
void require_sound(Display const& display, std::string const& file);
/// Reports what works but is probably unintended: unusual eye distances, unused windows and windows that cover each
/// other, walls and heads in other units, walls seen from behind, gaps between walls, skewed walls, blend bands that do
/// not match the overlap of their walls. Of a display without faults.
void report_doubts(Display const& display, gi::Report& report);

} // namespace viewer
