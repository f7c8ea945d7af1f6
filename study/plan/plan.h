#pragma once
// What will happen to one participant, step by step, before it happens.
//
// Orders are decided by integers and study::Random alone: seed and participant's number give the same plan with
// every compiler. Each block has random numbers of its own, so a change of one leaves the others as they were.

#include "study/script/condition.h"
#include "study/script/script.h"

#include <string_view>

namespace study {

enum class Phase { practice, main, catches };
std::string_view name_of(Phase phase); ///< practice, main, catch

struct Trial {
    Phase phase = Phase::main;
    int repeat = 1;                    ///< from 1; of adaptive procedures: which run
    std::vector<Stimulus> stimuli;     ///< a, b, c, ...
    std::string order;                 ///< what is shown, in this order, as letters: "ba"
    std::optional<Stimulus> reference; ///< shown too
    std::string answer;                ///< the right one; empty = there is none
    int procedure = -1;                ///< of the block
    std::optional<double> level;       ///< of what is varied; none = nothing, or chosen when the trial comes
    bool is_noise = false;             ///< there is nothing to find
};

enum class PlanStepKind { instructions, questionnaire, trial, rest, free_walk };
std::string_view name_of(PlanStepKind kind);

struct PlanStep {
    PlanStepKind kind = PlanStepKind::trial;
    int block = -1;   ///< instructions and rests within a block have it too
    int pass = 0;     ///< how often the block came before
    std::string text; ///< instructions: a file or Markdown; prompts
    int questionnaire = -1;
    std::vector<int> levels;                    ///< by factor, what is fixed where the step is; -1 = nothing
    int number = 0;                             ///< of a trial in its pass, from 1, over all phases
    Trial trial;                                ///< of a trial
    double seconds = 0;                         ///< of a free walk; least of a rest
    std::int64_t start_us = 0, duration_us = 0; ///< expected
    std::int64_t onset_us = 0;                  ///< expected, of a trial's first stimulus
};

struct Plan {
    int participant = 1;
    std::string participant_id; ///< "P001"
    std::vector<PlanStep> steps;
    std::int64_t duration_us = 0;
};

inline constexpr int kMostTrialsOfBlock = 5000, kMostTrials = 50000;

/// @param participant from 1
/// Throws ScriptError with the place in the script where the design cannot be: no order keeps a block's
/// constraints, more practice or catch trials than the block has room for, too many trials.
Plan make_plan(Script const& script, int participant);

/// The table plan.tsv: a line of column names, then one per step; UTF-8, tabs between, n/a where there is nothing.
std::string plan_table(Script const& script, Plan const& plan);

/// "similarity: visibility=ism_5" and such, for tables: the level of the factor that a block compares, or of what
/// it varies; rating and the like: their crossed levels.
std::string stimulus_label(Script const& script, Block const& block, Stimulus const& stimulus);

} // namespace study
