#pragma once
// A script's procedures as the statistics know them: for sessions that run them, and for analyses that go through
// them again.

#include "study/script/script.h"
#include "study/stats/questplus.h"
#include "study/stats/staircase.h"

namespace study {

/// Staircases step on an axis whose lower end is harder: the scale of `compare` times this, -1 where a higher
/// level is harder.
double harder_sign(Compare const& compare);
StaircaseSettings staircase_settings(Procedure const& procedure, Compare const& compare);
/// Stimuli and thresholds in levels where the function is Weibull's, else on the scale.
QuestSettings quest_settings(Procedure const& procedure, Compare const& compare);

} // namespace study
