#pragma once
// Answers that jump from guessing to knowing between two neighbouring levels: the likelihood of a threshold is the same
// anywhere between them (complete separation: Albert & Anderson 1984, Biometrika 71:1).

#include "study/stats/binomial.h"
#include "study/stats/psychometric_fit.h"

#include <optional>
#include <span>

namespace study {

struct StepGap {
    double low = 0, high = 0; ///< levels, low < high
    bool operator==(StepGap const&) const = default;
};

struct StepRates {
    std::optional<double> guess{}; ///< below the step; none = as the answers are, up to 0.5
    std::optional<double> lapse{}; ///< above it; none = as the answers are, up to 0.06
};

/// The gap in which a step explains the answers as well as any monotonic function that stays between the rates (up to a
/// quarter in log-likelihood); none if there is no such gap. Of several neighbouring gaps it is all of them.
std::optional<StepGap> step_gap(std::span<LevelCount const> counts, PsychometricShape const& shape,
                                StepRates const& rates);
/// Widens an interval of u (see transformed) so that it holds the gap.
void include_gap(StepGap const& gap, PsychometricShape const& shape, Interval& interval);
/// "any threshold between 2 and 3 fits these answers equally well, which change from guessing to knowing between them"
std::string text_of(StepGap const& gap);

} // namespace study
