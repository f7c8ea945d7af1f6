#pragma once
#include "study/run/presenter.h"
#include "study/run/progress.h"

namespace study {

/// Fully specified request for the next step.
TrialRequest request_of(Script const& script, Plan const& plan, Progress const& progress, NextStep const& due);

/// Determines whether the answer is correct and the trial valid. A trial is invalid with more dropped frames in
/// one stimulus than the script allows, or without an answer. Reasons set by the presenter are kept.
void judge(Script const& script, Trial const& trial, TrialDone& done);

} // namespace study
