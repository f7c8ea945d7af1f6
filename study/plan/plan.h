#pragma once
// The plan of one participant's session, step by step, made before it starts.
//
// Orders depend only on integers and study::Random: seed and participant number give the same plan with every
// compiler. Each block has its own random stream, so changing one block does not affect the others.

#include "study/script/condition.h"
#include "study/script/mistakes.h"
#include "study/script/script.h"

#include <functional>
#include <string_view>

namespace study {

enum class Phase { practice, main, catches };
std::string_view name_of(Phase phase); ///< practice, main, catch

struct Trial {
    Phase phase = Phase::main;
    int repeat = 1;                    ///< from 1; for adaptive procedures the number of the run
    std::vector<Stimulus> stimuli;     ///< a, b, c, ...
    std::string order;                 ///< letters of the stimuli in order of presentation: "ba"
    std::optional<Stimulus> reference; ///< also shown
    std::string answer;                ///< the correct one; empty = there is none
    int procedure = -1;                ///< of the block
    std::optional<double> level;       ///< of the varied setting; none = nothing varied, or chosen at the trial
    bool is_noise = false;             ///< there is nothing to find
    bool is_open_pair = false; ///< which pair is shown is chosen at the trial; until then it is the first one
};

enum class PlanStepKind { instructions, questionnaire, trial, rest, free_walk };
std::string_view name_of(PlanStepKind kind);

struct PlanStep {
    PlanStepKind kind = PlanStepKind::trial;
    int block = -1;   ///< also set for instructions and rests within a block
    int pass = 0;     ///< number of earlier passes of the block
    std::string text; ///< instructions: a file or Markdown; prompts
    int questionnaire = -1;
    std::vector<int> levels;                    ///< by factor, the level fixed at this step; -1 = none
    int number = 0;                             ///< of a trial in its pass, from 1, over all phases
    Trial trial;                                ///< only for trials
    double seconds = 0;                         ///< of a free walk; minimum of a rest
    std::int64_t start_us = 0, duration_us = 0; ///< expected
    std::int64_t onset_us = 0;                  ///< expected, of a trial's first stimulus
};

struct Plan {
    int participant = 1;
    std::string participant_id; ///< "P001"
    std::vector<PlanStep> steps;
    std::int64_t duration_us = 0;
};

/// The levels that occur in pairs, each once, rising.
std::vector<int> levels_of_pairs(Pairs const& pairs);

/// Stimuli that a trial may show, the reference included: its own, or all that its pair may be chosen from. Levels
/// that a procedure chooses are left open.
std::vector<Stimulus> possible_stimuli(Block const& block, Trial const& trial);

/// "P001", as the script's pattern has it.
std::string participant_id(Script const& script, int participant);
/// The factor whose levels are paired, ranked or compared by a block; -1 = none.
int compared_factor(Block const& block);

inline constexpr int kMostTrialsOfBlock = 5000, kMostTrials = 50000;

/// @param participant from 1
/// Throws ScriptError with the place in the script if the design is impossible: no order satisfies a block's
/// constraints, more practice or catch trials than fit into the block, too many trials.
Plan make_plan(Script const& script, int participant);

/// Makes the plans of participants 1 to `participants`; what is wrong with a block is added, and the other blocks
/// are planned nevertheless. Broken blocks are left out.
/// @param made  called with each plan
void find_plan_mistakes(Script const& script, int participants, Mistakes& m,
                        std::function<void(Plan const&)> const& made);

/// The table plan.tsv: a line of column names, then one per step; UTF-8, tab-separated, n/a = missing.
std::string plan_table(Script const& script, Plan const& plan);
/// The plan of such a table, whichever version wrote it. Columns that are not known are ignored.
/// @param file name in messages @throws ScriptError if a column is missing, or a row does not fit the script
Plan read_plan(Script const& script, int participant, std::string_view table, std::string const& file);
/// What differs between two such tables: "12 of 80 steps differ, the first is step 5 (order, answer)"; empty =
/// nothing.
std::string plan_difference(std::string_view recorded, std::string_view made);

/// Label of a stimulus in tables, such as "similarity: visibility=ism_5": the level of the factor that a block
/// compares, or of the setting that it varies; for ratings and similar tasks their crossed levels.
std::string stimulus_label(Script const& script, Block const& block, Stimulus const& stimulus);

} // namespace study
