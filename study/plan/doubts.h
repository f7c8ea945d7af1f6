#pragma once
// Warnings about designs that are valid but probably not intended.

#include "study/plan/plan.h"

#include <string>
#include <vector>

namespace study {

/// Warnings about valid but unusual designs, one line each: orders that do not occur equally often with the
/// planned number of participants, presentation orders that cannot be balanced within a condition, long sessions,
/// long stretches without a break, rules of gaze without a source of it.
std::vector<std::string> find_doubts(Script const& script);
/// The same for one participant's plan.
std::vector<std::string> find_doubts(Script const& script, Plan const& plan);
/// Adaptive procedures that cannot learn a threshold: QUEST+ whose prior has one point, or one value of the threshold,
/// staircases whose steps are wider than the range. Among the doubts above; analyses repeat them as cautions.
std::vector<std::string> find_idle_procedures(Script const& script);

} // namespace study
