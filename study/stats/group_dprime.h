#pragma once
// The mean d' of a population, from the answers of a sample of observers. d' and criterion of each observer are
// drawn from normal distributions; the likelihood of the means and standard deviations is that of all answers,
// integrated over the observers (adaptive Gauss-Hermite quadrature: Pinheiro & Bates 1995, J. Comput. Graph. Stat.
// 4:12). No observer's own d' is needed, so none is cut off at 0 or infinite, and the answers of observers with
// few trials are weighted as they deserve.
//
// Intervals are those of the profile likelihood, the means that would not be rejected, with the limit of Student's
// interval for n observers: see profile_limit.

#include "study/stats/binomial.h"
#include "study/stats/detection_model.h"

#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace study {

inline constexpr double kLeastDPrimeSd = 0.01; ///< fitted instead of 0, of d' and criteria between observers

struct GroupDPrime {
    double mean = 0;      ///< of d' in the population; may be infinite
    double deviation = 0; ///< standard deviation of d' between observers; at least kLeastDPrimeSd
    /// Of the deviation, by its profile: 0 where the answers do not show that observers differ; the upper end may be infinite. NaN
    /// with one observer, or if it is not asked for.
    Interval deviation_interval{std::nan(""), std::nan("")};
    double criterion = 0;
    Interval interval;            ///< of the mean; ends may be infinite
    double p = 1;                 ///< of "the mean is 0", by the same likelihood ratio
    std::vector<double> observer; ///< d' of each observer with trials: mean given the answers of all (shrunken)
    std::string note;             ///< what is doubtful; empty = nothing
};

/// Observers without trials are left out. @throws std::invalid_argument no observer has trials, or invalid counts
GroupDPrime group_dprime(DetectionTask task, std::span<DetectionCounts const> observers, double confidence = 0.95,
                         bool has_deviation = true);

} // namespace study
