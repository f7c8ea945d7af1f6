#pragma once
// Readable summaries of scripts and plans.

#include "study/plan/plan.h"

namespace study {

/// "1:02:03" or "2:03".
std::string clock_text(std::int64_t us);
/// Trials of one pass of a block, by phase.
struct TrialCounts {
    int practice = 0, main = 0, catches = 0, rests = 0;
};
TrialCounts count_trials(Plan const& plan, int block, int pass);

/// Summary of a script: participants, factors, orders, blocks with their trials and procedures.
/// @param plan of any participant
std::string script_text(Script const& script, Plan const& plan);
/// Every step with its expected time; one line per trial.
std::string order_text(Script const& script, Plan const& plan);
/// Trials by block and phase, counts of each level and answer, and transitions between trials.
std::string statistics_text(Script const& script, Plan const& plan);

} // namespace study
