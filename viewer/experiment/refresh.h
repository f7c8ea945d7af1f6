#pragma once
// Whether a display keeps time: what its swaps say of its refreshes. Times in seconds, lengths in milliseconds.

#include "study/journal/entries.h"
#include "study/script/script.h"

#include <span>

namespace viewer {

/// A swap later than so many refreshes after the one before has left a refresh out (as PsychoPy counts).
inline constexpr double kLate = 1.2;

/// How many refreshes passed between two swaps without a new picture.
int dropped_between(double seconds, double period_s);

/// Of the swaps of an empty screen, one after another. Passes where their intervals have a standard deviation of
/// at most max_sd_ms and a mean that differs from the nominal period by at most its share max_deviation.
/// @param nominal_hz  that the display tells; 0 = it does not: then `expected_hz` of the script counts
study::CalibrationDone judge_refresh(std::span<double const> swaps_s, double nominal_hz,
                                     study::Timing const& timing, std::string const& onset_method);

} // namespace viewer
