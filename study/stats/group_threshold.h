#pragma once
// The mean threshold of a population, from trials of a sample of observers: each observer's threshold is drawn
// from a normal distribution on the axis of levels; scale, lapse rate and overdispersion of the psychometric
// function are common to all. The likelihood is that of all answers, integrated over the observers' thresholds (as
// in group_dprime.h). A single run of 25 trials does not determine a slope, and its own best fit has a biased
// threshold; all runs together do, and nobody's threshold needs to be averaged or left out.
//
// The threshold is the level at which a proportion of answers is right (or yes), lapses included.
// Intervals of the mean are those of the profile likelihood. For thresholds of each observer see
// own_threshold.h and hierarchical_psychometric.h.

#include "study/stats/binomial.h"
#include "study/stats/psychometric_fit.h"

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace study {

struct ObserverLevels {
    std::vector<LevelCount> counts;
    double guess = 0.5; ///< proportion right, or yes, at the hardest levels
};

struct GroupThresholdSettings {
    PsychometricShape shape;
    double proportion = 0.75;
    double low = 0, high = 1; ///< the range of levels on offer
    double confidence = 0.95;
    std::optional<double> lapse{}; ///< fixed; none = it is fitted
    bool fits_guess = false;       ///< a common rate is fitted in place of those of the observers
    bool has_deviation = true;     ///< with the interval of the deviation
};

constexpr double kMostDeviation = 2; ///< of thresholds, in ranges

/// Thresholds and deviations in units of u (see transformed).
struct GroupThreshold {
    double mean = 0, deviation = 0; ///< of thresholds in the population
    Interval interval;              ///< of the mean; ends beyond 1.5 ranges from the range are infinite
    /// Of the deviation, by its profile: 0 where the answers do not show that observers differ, infinite beyond kMostDeviation
    /// ranges. NaN with one observer.
    Interval deviation_interval{std::nan(""), std::nan("")};
    PsychometricParameters shared;  ///< threshold: the mean; scale, guess, lapse
    double scale_error = 0;         ///< standard error of the scale's logarithm; 0 = not computed
    double eta = 0;                 ///< overdispersion: variance of n answers is n p q (1 + (n - 1) eta^2)
    bool are_levels_fixed = false;  ///< those of all observers are the same, as with constant stimuli
    int observers = 0;
    std::string note; ///< what is doubtful; empty = nothing
};

/// @throws std::invalid_argument no trials, levels off the axis, a range without width, a proportion that the
/// function cannot reach
GroupThreshold group_threshold(std::span<ObserverLevels const> observers, GroupThresholdSettings const& settings);
/// The same without its interval, which takes most of the time, and without errors.
GroupThreshold group_threshold_mode(std::span<ObserverLevels const> observers,
                                    GroupThresholdSettings const& settings);

} // namespace study
