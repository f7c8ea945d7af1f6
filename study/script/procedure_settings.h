#pragma once
// Converts a script's procedures to settings of study/stats: for sessions that run them and analyses that replay
// them.

#include "study/script/script.h"
#include "study/stats/questplus.h"
#include "study/stats/staircase.h"

namespace study {

/// Sign that makes lower values harder, as staircases need: the scale of `compare` is multiplied by it; -1 if a
/// higher level is harder.
double harder_sign(Compare const& compare);
StaircaseSettings staircase_settings(Procedure const& procedure, Compare const& compare);
/// Stimuli and thresholds are in levels for the Weibull function, otherwise on the scale.
QuestSettings quest_settings(Procedure const& procedure, Compare const& compare);

} // namespace study
