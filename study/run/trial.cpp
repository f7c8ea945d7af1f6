#include "study/run/trial.h"

namespace study {

TrialRequest request_of(Script const& script, Plan const& plan, Progress const& progress, NextStep const& due)
{
    PlanStep const& step = plan.steps[std::size_t(due.step)];
    TrialRequest r;
    r.script = &script;
    r.block = step.block >= 0 ? &script.blocks[std::size_t(step.block)] : nullptr;
    r.step = &step;
    r.step_index = due.step;
    r.attempt = due.attempt;
    r.trials_done = progress.trials_done();
    r.trials_planned = progress.trials_planned();
    if (step.kind != PlanStepKind::trial) {
        r.stimuli = {Stimulus{step.levels, false, {}}};
        return r;
    }
    r.stimuli = step.trial.stimuli;
    r.reference = step.trial.reference;
    r.level = due.level;
    for (Stimulus& stimulus : r.stimuli)
        if (stimulus.is_varied && !stimulus.level) stimulus.level = due.level;
    return r;
}

void judge(Script const& script, Trial const& trial, TrialDone& done)
{
    done.is_correct.reset();
    if (!trial.answer.empty() && !done.response.empty()) done.is_correct = done.response == trial.answer;
    if (!done.is_valid) return;
    for (StimulusShown const& shown : done.shown)
        if (shown.frames_dropped > script.timing.max_dropped_frames) done.reason = "dropped_frames";
    if (done.reason.empty() && done.response.empty() && !done.value) done.reason = "timeout";
    done.is_valid = done.reason.empty();
}

} // namespace study
