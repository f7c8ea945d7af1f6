#pragma once
#include "study/run/presenter.h"
#include "study/run/progress.h"

namespace study {

/// The step that is due, with everything decided.
TrialRequest request_of(Script const& script, Plan const& plan, Progress const& progress, NextStep const& due);

/// Whether the answer is right, and whether the trial is valid: not with more dropped frames than the script
/// allows in one stimulus, nor without an answer. What the presenter found wrong stays.
void judge(Script const& script, Trial const& trial, TrialDone& done);

} // namespace study
