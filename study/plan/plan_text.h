#pragma once
// Scripts and plans for people to read.

#include "study/plan/plan.h"

namespace study {

/// "1:02:03" or "2:03".
std::string clock_text(std::int64_t us);
/// Trials of one pass of a block, by phase.
struct TrialCounts {
    int practice = 0, main = 0, catches = 0, rests = 0;
};
TrialCounts count_trials(Plan const& plan, int block, int pass);

/// What a script holds: participants, factors, orders, blocks with their trials and procedures.
/// @param plan of any participant
std::string script_text(Script const& script, Plan const& plan);
/// Every step with its expected time; trials in one line each.
std::string order_text(Script const& script, Plan const& plan);
/// Trials by block and phase, how often each level and answer comes, and how one trial follows another.
std::string statistics_text(Script const& script, Plan const& plan);

} // namespace study
