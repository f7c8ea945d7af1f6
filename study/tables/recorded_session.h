#pragma once
// A session as it was planned and as its journal says that it went.

#include "study/journal/entries.h"
#include "study/plan/plan.h"

#include <span>

namespace study {

struct RecordedSession {
    Plan plan;
    SessionRecord record;
};

/// What the first entry of a journal says. @throws ScriptError where it has none, or where it is of another
/// experiment or participant than plan and script
SessionStarted const& start_of(Script const& script, RecordedSession const& session);
/// Whether every step was done.
bool is_complete(RecordedSession const& session);

/// Entries with the time that has passed since the session's beginning. Clocks start anew in each part: the end of
/// the part before and the gap that the wall clock shows (if it is positive) are added.
struct TimedEntry {
    JournalEntry const* entry;
    int part;
    double offset_s; ///< time since the beginning = the entry's own times + offset_s
};
std::vector<TimedEntry> timed_entries(RecordedSession const& session);

/// Why a trial does not count in analyses; `counted` = it does.
enum class TrialStatus {
    counted,
    practice,
    catch_trial, ///< counts for attention only
    superseded,  ///< was repeated later
    invalid,     ///< flagged, and not repeated (yet)
    unanswered,
};
std::string_view name_of(TrialStatus status);

/// A trial that was carried through, with its place in the plan.
struct TrialRow {
    PlanStep const* step;
    Block const* block;
    TrialDone const* done;
    int session, part;
    double offset_s; ///< as TimedEntry
    TrialStatus status;
    bool is_kept_though_invalid; ///< counted because the script says on_bad_trial: keep
};
/// In the order of the journal. The pointers are into script, session and plan.
/// @throws ScriptError where the journal names a step that the plan has no trial at
std::vector<TrialRow> trial_rows(Script const& script, RecordedSession const& session);

/// The stimulus with that letter; of the reference: 'r'. Null where the trial has none.
Stimulus const* stimulus_of(Trial const& trial, char letter);
/// The level of a factor that all stimuli of a trial share; -1 = none, since it is what the block compares.
int shared_level(Block const& block, Trial const& trial, int factor);
/// The factor whose levels are paired, ranked or compared by a block; -1 = none.
int compared_factor(Block const& block);
/// The answer chosen as the letter of a stimulus, of tasks that choose one of the stimuli shown: 'b' of order "ba"
/// and response "first"; nothing of other answers.
std::optional<char> chosen_letter(TrialRow const& row);

} // namespace study
