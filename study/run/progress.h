#pragma once
// The next step of a session, computed from the plan and the journal so far. Running and resumed sessions use the
// same class; its state depends only on plan and entries.

#include "study/journal/entries.h"
#include "study/plan/plan.h"
#include "study/run/adaptive_run.h"
#include "study/run/pair_run.h"

#include <deque>
#include <map>

namespace study {

struct NextStep {
    int step = 0, attempt = 1;
    bool is_questionnaire_of_trial = false;    ///< the trial of the step is done, its questionnaire is not
    std::optional<double> level;               ///< of the varied setting
    std::vector<double> also{};                ///< levels of further varied settings
    std::optional<std::pair<int, int>> pair{}; ///< levels of the paired factor, if the pair is chosen at the trial
};

/// Maximum number of attempts at a trial that is not valid, including the first.
inline constexpr int kMostAttempts = 3;

/// The rules:
/// - Steps come in the order of the plan. Invalid practice trials are never repeated.
/// - Other invalid trials (if the script sets repeat_at_end) are repeated at the end of their pass of the block,
///   in the order in which they failed, until they are valid or were tried kMostAttempts times; trials that the
///   experimenter skipped are not repeated.
/// - Procedures receive only valid trials. When a run has finished, its remaining trials are dropped; if no main
///   trial of the pass remains, its catch trials and breaks are dropped too.
/// - The recorded level of a trial counts, also where a procedure would choose another one now.
/// - Pairs that are chosen at the trial stay those of the trial when it is repeated. Only valid answers count for
///   the choice of later ones. The recorded pair counts, so that another machine resumes the same session.
/// - After a gap longer than resume.max_gap_min, or of unknown length (the wall clock went back), the parts listed
///   in resume.repeat are repeated for the current block: its instructions, or the last ones before it, and its
///   practice.
class Progress {
public:
    /// Both must outlive this object. @throws ScriptError if a procedure cannot be run
    Progress(Script const& script, Plan const& plan);

    /// The next step; none = every step is done.
    std::optional<NextStep> next() const;
    /// @throws std::invalid_argument if the entry is inconsistent with this plan and the earlier entries
    void apply(JournalEntry const& entry);

    bool was_asked() const { return was_asked_; } ///< the questions about the participant
    int trials_planned() const { return trials_planned_; }
    int trials_done() const { return trials_done_; } ///< of the plan, valid or not, each counted once
    int levels_not_due() const
    {
        return levels_not_due_;
    } ///< trials at levels that a procedure chooses otherwise now

private:
    using RunKey = std::tuple<int, int, int, int, std::vector<int>>; ///< block, pass, procedure, repeat, cell

    void add_pair_run(std::size_t step);
    void check_levels(TrialDone const& trial, NextStep const& due);
    void apply_pair(TrialDone const& trial, bool is_first);
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
    std::vector<AdaptiveRun*> run_of_step_;           ///< null = none
    std::map<RunKey, PairRun> pair_runs_;             ///< by cell
    std::vector<PairRun*> pair_run_of_step_;          ///< null = none
    std::map<int, std::pair<int, int>> pair_of_step_; ///< of trials that were shown
    std::vector<int> attempts_;
    std::vector<bool> is_done_; ///< by step of the plan, without repeats
    std::deque<int> again_;     ///< invalid trials, in the order in which they will be repeated
    std::deque<int> refresh_;   ///< steps repeated after a gap
    int questionnaire_of_ = -1; ///< step of the trial whose questionnaire is due
    int trials_planned_ = 0, trials_done_ = 0, levels_not_due_ = 0;
    bool was_asked_ = false;
};

} // namespace study
