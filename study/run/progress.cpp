#include "study/run/progress.h"

#include "study/script/procedure_settings.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace study {
namespace {

constexpr double kClockNoise_s = 60; ///< smaller backward jumps of clocks are ignored

bool is_same_level(std::optional<double> a, std::optional<double> b)
{
    if (!a || !b) return !a && !b;
    return std::abs(*a - *b) <= 1e-8 * std::max(std::abs(*a), std::abs(*b)); // plan.tsv has nine digits
}

bool is_adaptive_block(Block const& b)
{
    return std::any_of(b.procedures.begin(), b.procedures.end(),
                       [](Procedure const& p) { return is_adaptive(p); });
}

} // namespace

Progress::Progress(Script const& script, Plan const& plan)
    : script_(script),
      plan_(plan),
      run_of_step_(plan.steps.size()),
      pair_run_of_step_(plan.steps.size()),
      attempts_(plan.steps.size()),
      is_done_(plan.steps.size())
{
    for (std::size_t i = 0; i < plan.steps.size(); ++i) {
        PlanStep const& s = plan.steps[i];
        if (s.kind != PlanStepKind::trial) continue;
        ++trials_planned_;
        if (s.trial.is_open_pair) add_pair_run(i);
        Block const& b = script.blocks[std::size_t(s.block)];
        if (s.trial.procedure < 0 || !is_adaptive(b.procedures[std::size_t(s.trial.procedure)])) continue;
        RunKey const key{s.block, s.pass, s.trial.procedure, s.trial.repeat, s.trial.stimuli[0].levels};
        auto found = runs_.find(key);
        if (found == runs_.end())
            found = runs_
                        .emplace(key, AdaptiveRun(b.procedures[std::size_t(s.trial.procedure)], *b.compare,
                                                  script.file))
                        .first;
        run_of_step_[i] = &found->second;
    }
}

void Progress::add_pair_run(std::size_t i)
{
    PlanStep const& s = plan_.steps[i];
    Block const& b = script_.blocks[std::size_t(s.block)];
    RunKey const key{s.block, s.pass, -1, 0,
                     s.trial.stimuli[0].levels}; // those of the first pair in all of its cell
    auto found = pair_runs_.find(key);
    if (found == pair_runs_.end()) {
        constexpr std::uint64_t kPairPurpose = std::uint64_t(1) << 61;
        std::uint64_t const purpose = kPairPurpose + pair_runs_.size();
        found = pair_runs_.emplace(key, PairRun(script_, b, plan_.participant, purpose)).first;
    }
    pair_run_of_step_[i] = &found->second;
}

bool Progress::is_same_pass(int a, int b) const
{
    return at(a).block >= 0 && at(a).block == at(b).block && at(a).pass == at(b).pass;
}

bool Progress::has_main_trial_after(int step) const
{
    for (int i = step + 1; i < int(plan_.steps.size()) && is_same_pass(step, i); ++i)
        if (at(i).kind == PlanStepKind::trial && at(i).trial.phase == Phase::main && !is_done_[std::size_t(i)] &&
            !falls_away(i))
            return true;
    return false;
}

bool Progress::falls_away(int step) const
{
    PlanStep const& s = at(step);
    if (AdaptiveRun const* const run = run_of_step_[std::size_t(step)]) return run->finished();
    if (s.block < 0 || !is_adaptive_block(script_.blocks[std::size_t(s.block)])) return false;
    bool const is_catch = s.kind == PlanStepKind::trial && s.trial.phase == Phase::catches;
    return (is_catch || s.kind == PlanStepKind::rest) && !has_main_trial_after(step);
}

NextStep Progress::due_of(int step) const
{
    NextStep due{step, attempts_[std::size_t(step)] + 1, false, {}};
    if (at(step).kind != PlanStepKind::trial) return due;
    due.level = at(step).trial.level;
    if (AdaptiveRun const* const run = run_of_step_[std::size_t(step)]) {
        due.level = run->level();
        due.also = run->also();
    }
    if (PairRun const* const run = pair_run_of_step_[std::size_t(step)]) {
        auto const shown = pair_of_step_.find(step);
        due.pair = shown != pair_of_step_.end() ? shown->second : run->next();
    }
    return due;
}

std::optional<NextStep> Progress::next() const
{
    if (!refresh_.empty()) return due_of(refresh_.front());
    if (questionnaire_of_ >= 0)
        return NextStep{questionnaire_of_, attempts_[std::size_t(questionnaire_of_)], true, {}};
    int step = 0;
    while (step < int(plan_.steps.size()) && (is_done_[std::size_t(step)] || falls_away(step))) ++step;
    bool const is_over = step == int(plan_.steps.size());
    for (int const bad : again_) {
        AdaptiveRun const* const run = run_of_step_[std::size_t(bad)];
        bool const is_needed = run == nullptr || !run->finished();
        if (is_needed && (is_over || !is_same_pass(bad, step))) return due_of(bad);
    }
    if (is_over) return {};
    return due_of(step);
}

void Progress::expect(int step, bool is_fine, char const* what) const
{
    auto const due = next();
    if (!due) throw std::invalid_argument(fmt::format("{} of step {} after everything was done", what, step + 1));
    if (due->step != step || !is_fine)
        throw std::invalid_argument(fmt::format("{} of step {} although step {} of the plan, attempt {}, is due",
                                                what, step + 1, due->step + 1, due->attempt));
}

void Progress::pass(int step)
{
    if (!refresh_.empty()) {
        refresh_.pop_front();
        return;
    }
    auto const again = std::find(again_.begin(), again_.end(), step);
    if (again != again_.end())
        again_.erase(again);
    else if (at(step).kind == PlanStepKind::trial)
        ++trials_done_;
    is_done_[std::size_t(step)] = true;
}

void Progress::apply_trial(TrialDone const& t)
{
    auto const due = next();
    bool const is_trial = due && at(due->step).kind == PlanStepKind::trial && !due->is_questionnaire_of_trial;
    expect(t.step, is_trial && t.attempt == due->attempt, "a trial");
    bool const is_refresh = !refresh_.empty();
    if (t.reason != "skipped") check_levels(t, *due);
    pass(t.step);
    attempts_[std::size_t(t.step)] = t.attempt;
    if (pair_run_of_step_[std::size_t(t.step)] != nullptr) apply_pair(t, !pair_of_step_.contains(t.step));
    if (is_refresh) return;
    PlanStep const& s = at(t.step);
    if (t.is_valid) {
        if (AdaptiveRun* const run = run_of_step_[std::size_t(t.step)]) run->respond(t.is_correct.value_or(false));
        if (script_.blocks[std::size_t(s.block)].task == Task::questionnaire) questionnaire_of_ = t.step;
        return;
    }
    bool const comes_again = script_.timing.on_bad_trial == BadTrial::repeat_at_end && t.attempt < kMostAttempts &&
                             s.trial.phase != Phase::practice && t.reason != "skipped";
    if (comes_again) again_.push_back(t.step);
}

void Progress::check_levels(TrialDone const& t, NextStep const& due)
{
    auto const& compare = script_.blocks[std::size_t(at(t.step).block)].compare;
    bool const is_due =
        is_same_level(t.level, due.level) && (due.also.empty() || t.chosen == further_text(*compare, due.also));
    if (is_due) return;
    AdaptiveRun* const run = run_of_step_[std::size_t(t.step)];
    if (run == nullptr || !t.level)
        throw std::invalid_argument(fmt::format("a trial of step {} at level {} although {} is due", t.step + 1,
                                                t.level ? level_text(*t.level) : "none",
                                                due.level ? level_text(*due.level) : "none"));
    run->choose(*t.level, further_of_text(*compare, t.chosen));
    ++levels_not_due_;
}

void Progress::apply_pair(TrialDone const& t, bool is_first)
{
    if (t.reason == "skipped" && t.chosen.empty()) return;
    PlanStep const& s = at(t.step);
    auto const pair = pair_of_text(script_, script_.blocks[std::size_t(s.block)], t.chosen);
    if (!pair || (!is_first && pair_of_step_[t.step] != *pair))
        throw std::invalid_argument(
            fmt::format("a trial of step {} with the pair '{}', which is not due", t.step + 1, t.chosen));
    pair_of_step_[t.step] = *pair;
    pair_run_of_step_[std::size_t(t.step)]->shown(*pair, s.trial.order, t.is_valid ? t.response : "");
}

void Progress::apply_step(StepDone const& done)
{
    expect(done.step, true, "a step");
    auto const due = next();
    attempts_[std::size_t(done.step)] = due->attempt;
    if (due->is_questionnaire_of_trial)
        questionnaire_of_ = -1; // skipped
    else
        pass(done.step);
}

void Progress::apply_started(SessionStarted const& started)
{
    double const gap = started.gap_s;
    bool const is_long = !(gap <= script_.resume.max_gap_min * 60 && gap >= -kClockNoise_s);
    if (started.part == 1 || !is_long) return;
    refresh_.clear();
    auto const due = next();
    if (!due || at(due->step).block < 0 || at(due->step).kind == PlanStepKind::instructions) return;
    if (script_.resume.instructions)
        for (int i = due->step; i >= 0; --i)
            if (at(i).kind == PlanStepKind::instructions && (at(i).block < 0 || is_same_pass(i, due->step))) {
                refresh_.push_back(i);
                break;
            }
    if (!script_.resume.practice) return;
    for (int i = 0; i < int(plan_.steps.size()); ++i)
        if (is_same_pass(i, due->step) && at(i).kind == PlanStepKind::trial &&
            at(i).trial.phase == Phase::practice && is_done_[std::size_t(i)])
            refresh_.push_back(i);
}

void Progress::apply(JournalEntry const& entry)
{
    if (auto const* const started = std::get_if<SessionStarted>(&entry)) apply_started(*started);
    if (auto const* const trial = std::get_if<TrialDone>(&entry)) apply_trial(*trial);
    if (auto const* const step = std::get_if<StepDone>(&entry)) apply_step(*step);
    if (auto const* const items = std::get_if<QuestionnaireDone>(&entry))
        apply_step({items->step, items->start_s, items->end_s, ""});
    if (std::holds_alternative<ParticipantAsked>(entry)) was_asked_ = true;
}

} // namespace study
