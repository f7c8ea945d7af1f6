#pragma once
// One participant's session: a plan, run through a presenter, kept in a journal.

#include "study/journal/journal_folders.h"
#include "study/run/presenter.h"

#include <filesystem>
#include <functional>

namespace study {

enum class SessionStart {
    begin, ///< a new one; what is there is never overwritten
    go_on, ///< one that is there, after its last entry; begins it where nothing has happened yet
};

struct SessionSettings {
    std::filesystem::path dir;           ///< of the data set; made where it is missing
    std::filesystem::path script_folder; ///< where the Markdown files of the script lie
    std::string script_text;             ///< whole, for its hash
    int session = 1;                     ///< 1 to 99
    SessionStart start = SessionStart::begin;
    std::string version, git_hash;
    std::vector<std::pair<std::string, std::string>> about; ///< provenance beside the presenter's own
    bool is_simulated = false;
    std::function<double()> unix_s; ///< the wall clock; none = the machine's
    /// Called with each entry once it is on the disk.
    std::function<void(JournalEntry const&)> on_kept;
    /// Called when the session has ended, whole or not, so that tables can be made anew: the folder, all entries.
    /// Also where it is asked to go on and was complete.
    std::function<void(std::filesystem::path const&, SessionRecord const&)> on_ended;
};

struct SessionOutcome {
    std::filesystem::path folder;              ///< empty where nothing is kept: the participant did not agree
    bool is_complete = false;                  ///< every step of the plan is done
    std::string reason;                        ///< why not
    int trials = 0, bad_trials = 0, steps = 0; ///< of this part
    std::size_t torn_bytes = 0;                ///< cut off the journal's end before going on
    /// Between two trials: journal, choice of what comes next; with and without waiting for the disk.
    std::vector<double> bookkeeping_ms, unsynced_ms;
};

/// @throws ScriptError where this session of the participant is there already, or the folder has sessions of
/// another script, as run_session does
void check_is_new(std::string const& participant_id, SessionSettings const& settings);

/// The folder then has plan.tsv (the whole order, before the first trial), journal.jsonl (the truth) and
/// session.json (a summary).
/// @throws ScriptError where the session cannot begin or go on, and nothing of it was written: it is there
/// already, another process runs it, its script or that of other sessions in the folder is another, the display
/// does not pass its test and the script requires it; and where the disk fails, after which the journal has all
/// entries before
SessionOutcome run_session(Script const& script, int participant, Presenter& presenter,
                           SessionSettings const& settings);

} // namespace study
