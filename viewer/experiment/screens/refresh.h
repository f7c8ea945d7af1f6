#pragma once
// Checks the timing of a display: refreshes estimated from swap times.
// Times in seconds, durations in milliseconds.

#include "study/journal/entries.h"
#include "study/script/script.h"

#include <span>

namespace viewer {

/// A swap later than this many refreshes after the previous one has skipped a refresh (as in PsychoPy).
inline constexpr double kLate = 1.2;

/// Number of refreshes without a new picture between two swaps.
int dropped_between(double seconds, double period_s);

/// Evaluates successive swaps of an empty screen. Passes if their intervals have a standard deviation of at most
/// max_sd_ms and their mean differs from the nominal period by at most the share max_deviation of it.
/// @param nominal_hz  reported by the display; 0 = unknown, `expected_hz` of the script is used
study::CalibrationDone judge_refresh(std::span<double const> swaps_s, double nominal_hz,
                                     study::Timing const& timing, std::string const& onset_method);

} // namespace viewer
