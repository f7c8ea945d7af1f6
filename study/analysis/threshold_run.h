#pragma once
#include "study/analysis/groups.h"

namespace study {

/// Proportion correct by guessing.
double guess_rate(Task task);
/// Converts a value in units of the scale, such as a mean of reversals, to a level.
double back_to_level(Compare const& compare, double on_scale);

/// Analyses one run of one procedure by one observer, in the order of its trials: its reversals, and all estimates
/// of its threshold for which there are data.
/// @param trials of this run, valid ones with an answer
ThresholdRun threshold_run(Block const& block, Procedure const& procedure, std::vector<TrialRow> const& trials,
                           AnalysisSettings const& settings);

} // namespace study
