#include "study/run/trial.h"

#include "study/script/procedure_settings.h"

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
    if (due.pair) {
        std::size_t const factor = std::size_t(r.block->pairs->factor);
        r.stimuli[0].levels[factor] = due.pair->first;
        r.stimuli[1].levels[factor] = due.pair->second;
    }
    for (Stimulus& stimulus : r.stimuli) {
        if (stimulus.is_varied && !stimulus.level) stimulus.level = due.level;
        stimulus.also = due.also; // the stimuli differ only in the setting of vary
    }
    return r;
}

namespace {

/// Why an answer at this time does not count; empty = it does.
std::string outside_limits(TrialTiming const& limits, std::optional<double> reaction_ms)
{
    if (!reaction_ms) return "";
    if (*reaction_ms < limits.min_response_ms) return kAnticipation;
    return limits.max_response_ms && *reaction_ms > *limits.max_response_ms ? kTooSlow : "";
}

} // namespace

void judge(Script const& script, PlanStep const& step, TrialDone& done)
{
    Trial const& trial = step.trial;
    done.is_correct.reset();
    if (!trial.answer.empty() && !done.response.empty()) done.is_correct = done.response == trial.answer;
    if (!done.is_valid) return;
    for (StimulusShown const& shown : done.shown)
        if (shown.frames_dropped > script.timing.max_dropped_frames) done.reason = "dropped_frames";
    if (done.reason.empty() && done.response.empty() && !done.value) done.reason = "timeout";
    bool const is_answered = !done.response.empty() || done.value;
    if (done.reason.empty() && is_answered && step.block >= 0)
        done.reason = outside_limits(script.blocks[std::size_t(step.block)].timing, done.reaction_ms);
    done.is_valid = done.reason.empty();
}

void complete(Script const& script, Plan const& plan, NextStep const& due, TrialDone& done)
{
    PlanStep const& step = plan.steps[std::size_t(due.step)];
    done.step = due.step;
    done.attempt = due.attempt;
    done.level = due.level;
    if (!due.also.empty()) done.chosen = further_text(*script.blocks[std::size_t(step.block)].compare, due.also);
    if (due.pair) done.chosen = pair_text(script, script.blocks[std::size_t(step.block)], *due.pair);
    judge(script, step, done);
}

} // namespace study
