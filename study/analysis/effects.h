#pragma once
#include "study/analysis/measure.h"

namespace study {

/// Tests effects of conditions and of groups of participants on a measure: an analysis of variance of observers'
/// means (mixed_anova.h) if there is something to compare, and Welch's tests between groups in each condition and
/// over all. Observers without one of the cells are left out of the former, with a note.
void test_effects(Measure const& measure, std::vector<ParticipantFactor> const& groups,
                  AnalysisSettings const& settings, Analysis& analysis);

} // namespace study
