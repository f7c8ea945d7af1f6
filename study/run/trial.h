#pragma once
// A trial before and after it is shown: its request, whether its answer is correct, whether it counts.

#include "study/run/presenter.h"
#include "study/run/progress.h"

namespace study {

/// Fully specified request for the next step.
TrialRequest request_of(Script const& script, Plan const& plan, Progress const& progress, NextStep const& due);

/// Determines whether the answer is correct and the trial valid. A trial is invalid with more dropped frames in
/// one stimulus than the script allows, without an answer, or with an answer outside of min_response_ms and
/// max_response_ms. Reasons set by the presenter are kept.
void judge(Script const& script, PlanStep const& step, TrialDone& done);
/// Adds to a trial that was shown what was due, and judges it.
void complete(Script const& script, Plan const& plan, NextStep const& due, TrialDone& done);

} // namespace study
