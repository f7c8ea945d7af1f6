#pragma once
// What is due next in a session: the plan, and what its journal says of it so far. A session that runs and one
// that goes on later ask the same object; its state follows from plan and entries alone.

#include "study/journal/entries.h"
#include "study/plan/plan.h"
#include "study/run/adaptive_run.h"

#include <deque>
#include <map>

namespace study {

struct NextStep {
    int step = 0, attempt = 1;
    bool is_questionnaire_of_trial = false; ///< the trial of the step is done, its items are not
    std::optional<double> level;            ///< of what is varied
};

/// A trial that is not valid is done again so often at most, the first time included.
inline constexpr int kMostAttempts = 3;

/// The rules:
/// - Steps come in the order of the plan. Practice is never repeated for being bad.
/// - Other trials that are not valid (where the script says repeat_at_end) come again at the end of their pass of
/// the
///   block, in the order in which they failed, until they are valid or were tried kMostAttempts times; not those
///   that the experimenter skipped.
/// - Procedures hear of valid trials only. When a run has finished its remaining trials fall away, and with them,
/// where
///   no main trial of the pass is left, its catch trials and breaks.
/// - After a gap longer than resume.max_gap_min, or one that the wall clock cannot tell (it went back), what
///   resume.repeat says of the block that is under way comes again: its instructions, or the last ones before it,
///   and its practice.
class Progress {
public:
    /// Both must live as long as this. @throws ScriptError where a procedure cannot be run
    Progress(Script const& script, Plan const& plan);

    /// None: every step is done.
    std::optional<NextStep> next() const;
    /// @throws std::invalid_argument where the entry cannot follow from this plan and the entries before
    void apply(JournalEntry const& entry);

    bool was_asked() const { return was_asked_; } ///< about the participant
    int trials_planned() const { return trials_planned_; }
    int trials_done() const { return trials_done_; } ///< of the plan, valid or not, each once

private:
    using RunKey = std::tuple<int, int, int, int, std::vector<int>>; ///< block, pass, procedure, repeat, cell

    void apply_started(SessionStarted const& started);
    void apply_trial(TrialDone const& trial);
    void apply_step(StepDone const& done);
    void expect(int step, bool is_fine, char const* what) const;
    void pass(int step);
    bool falls_away(int step) const;
    bool has_main_trial_after(int step) const;
    bool is_same_pass(int a, int b) const;
    NextStep due_of(int step) const;
    PlanStep const& at(int step) const { return plan_.steps[std::size_t(step)]; }

    Script const& script_;
    Plan const& plan_;
    std::map<RunKey, AdaptiveRun> runs_;
    std::vector<AdaptiveRun*> run_of_step_; ///< null = none
    std::vector<int> attempts_;
    std::vector<bool> is_done_; ///< of the plan's order, not of repeats
    std::deque<int> again_;     ///< bad trials, in the order in which they come again
    std::deque<int> refresh_;   ///< after a gap
    int questionnaire_of_ = -1; ///< a trial's step
    int trials_planned_ = 0, trials_done_ = 0;
    bool was_asked_ = false;
};

} // namespace study
