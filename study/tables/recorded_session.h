#pragma once
// A session: its plan and its record.

#include "study/journal/entries.h"
#include "study/plan/plan.h"
#include "study/run/session_plan.h"

#include <span>

namespace study {

/// How detailed the records of trials are: tables of other programs may have only sums.
enum class TrialDetail {
    trials, ///< each trial, in its order
    counts, ///< not their order
    wins,   ///< neither their order, nor which stimulus was shown first, nor who chose
};

struct RecordedSession {
    Plan plan;
    SessionRecord record;
    TrialDetail detail = TrialDetail::trials;
    PlanSource plan_source = PlanSource::same;
};

/// Sets the pairs that were chosen during the session in the plan's trials.
void fill_chosen(Script const& script, RecordedSession& session);

/// The first entry of the journal. @throws ScriptError if there is none, or it belongs to another experiment or
/// participant than plan and script
SessionStarted const& start_of(Script const& script, RecordedSession const& session);
/// What a session recorded of itself under this name; empty = nothing.
std::string recorded_fact(SessionStarted const& start, std::string_view key);
/// Of such a fact: "1920 x 1080"; none if it is no two numbers above 0.
std::optional<std::pair<double, double>> recorded_pair(SessionStarted const& start, std::string_view key);
/// True if every step was done.
bool is_complete(RecordedSession const& session);

/// Entries with the time since the session's beginning. Clocks restart in each part: the end of the previous part
/// and the gap by the wall clock (if it is positive) are added.
struct TimedEntry {
    JournalEntry const* entry;
    int part;
    double offset_s; ///< time since the beginning = the entry's own times + offset_s
};
std::vector<TimedEntry> timed_entries(RecordedSession const& session);

/// Whether a trial counts in analyses, or why not.
enum class TrialStatus {
    counted,
    practice,
    catch_trial, ///< counts for attention only
    superseded,  ///< repeated later
    invalid,     ///< invalid and not repeated (yet)
    unanswered,
};
std::string_view name_of(TrialStatus status);

/// A trial that ran to its end, with its place in the plan.
struct TrialRow {
    PlanStep const* step;
    Block const* block;
    TrialDone const* done;
    int session, part;
    double offset_s; ///< as TimedEntry
    TrialStatus status;
    bool is_kept_though_invalid; ///< counted because the script sets on_bad_trial: keep
};
/// All trials in the order of the journal. The pointers are into script, session and plan.
/// @throws ScriptError if the journal has a trial at a step that is not a trial in the plan
std::vector<TrialRow> trial_rows(Script const& script, RecordedSession const& session);

/// The stimulus with this letter; 'r' = the reference. Null if the trial has none.
Stimulus const* stimulus_of(Trial const& trial, char letter);
/// The level of a factor that all stimuli of a trial share; -1 = none, because the block compares this factor.
int shared_level(Block const& block, Trial const& trial, int factor);
/// The level of that factor; in blocks of pairs both: "a vs b".
std::string compared_label(Script const& script, Block const& block, Trial const& trial);
/// Letter of the chosen stimulus, for tasks that choose one of the stimuli: 'b' for order "ba" and response
/// "first"; none for other answers.
std::optional<char> chosen_letter(TrialRow const& row);

} // namespace study
