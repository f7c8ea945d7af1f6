#pragma once
// Psychometric functions by maximum likelihood alone: by formulas, which the models of groups of observers do not
// know (group_threshold.h), and with rates that are given, as other programs fit them.

#include "study/analysis/analysis.h"

namespace study {

/// The threshold by one run's own trials. Its lapse rate is settings.lapse, or 2 %: one run cannot determine it.
/// @param guess  none = 0 is assumed
ThresholdEstimate maximum_likelihood_estimate(ThresholdRun const& run, Block const& block,
                                              PsychometricChoice const& function, std::optional<double> guess,
                                              double proportion, AnalysisSettings const& settings);

/// Sets counts, function and threshold: one function through the trials of all observers, with a bootstrap over
/// observers. `cell`, `function`, `observers`, `shape` and `proportion` are set.
void fit_pooled(CurveResult& curve, Block const& block, std::vector<std::vector<LevelCount>> const& observers,
                double guess, AnalysisSettings const& settings);

} // namespace study
