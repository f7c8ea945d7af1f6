#pragma once
// How peak velocity and duration of saccades rise with their amplitude (Bahill, Clark and Stark 1975, The main
// sequence, Math. Biosci. 24:191-204).

#include "study/gaze/gaze_events.h"

namespace study {

struct MainSequence {
    int saccades = 0; ///< that count: whole ones of 0.5 degrees and more
    /// peak velocity = at_one_deg * amplitude^slope, by least squares of logarithms: slope of the line in a plot with
    /// logarithmic axes, and its standard error. NaN with fewer than three saccades, or equal amplitudes.
    double slope = NAN, slope_se = NAN, at_one_deg = NAN;
    /// duration = ms_at_zero + ms_per_deg * amplitude, by least squares.
    double ms_per_deg = NAN, ms_per_deg_se = NAN, ms_at_zero = NAN;
};

inline constexpr double kMainSequenceFrom_deg = 0.5;

MainSequence main_sequence(std::vector<Saccade> const& saccades);

} // namespace study
