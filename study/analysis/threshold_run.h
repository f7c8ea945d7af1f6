#pragma once
#include "study/analysis/groups.h"

namespace study {

/// How the axis of a psychometric function follows from the scale of a comparison: harder levels are lower on it.
PsychometricShape shape_of(Compare const& compare, Psychometric function = Psychometric::normal);
/// The share of right answers by guessing.
double guess_rate(Task task);
/// A level from the middle of a threshold in units of the scale, e.g. a mean of reversals.
double back_to_level(Compare const& compare, double on_scale);

/// One run of one procedure by one observer, in the order of its trials: its reversals, and every estimate of its
/// threshold that there are data for.
/// @param trials of this run, valid ones with an answer
ThresholdRun threshold_run(Block const& block, Procedure const& procedure, std::vector<TrialRow> const& trials,
                           AnalysisSettings const& settings);

} // namespace study
