#pragma once
// One participant's session: runs a plan with a presenter and records it in a journal.

#include "study/journal/journal_folders.h"
#include "study/run/presenter.h"

#include <filesystem>
#include <functional>

namespace study {

enum class SessionStart {
    begin, ///< starts a new session; existing records are never overwritten
    go_on, ///< resumes an existing session after its last entry; starts it if it has no entries yet
};

struct SessionSettings {
    std::filesystem::path dir;           ///< of the data set; created if missing
    std::filesystem::path script_folder; ///< folder of the script's Markdown files
    std::string script_text;             ///< complete, for its hash
    int session = 1;                     ///< 1 to 99
    SessionStart start = SessionStart::begin;
    std::string version, git_hash;
    std::vector<std::pair<std::string, std::string>> about; ///< provenance in addition to the presenter's
    bool is_simulated = false;
    std::function<double()> unix_s; ///< the wall clock; none = the machine's
    /// Called with each entry once it is on the disk.
    std::function<void(JournalEntry const&)> on_kept;
};

struct SessionOutcome {
    std::filesystem::path folder;              ///< empty if nothing is recorded: the participant did not consent
    bool is_complete = false;                  ///< every step of the plan is done
    std::string reason;                        ///< why not
    int trials = 0, bad_trials = 0, steps = 0; ///< of this part
    std::size_t torn_bytes = 0;                ///< cut off the journal's end before resuming
    std::string
        plan_remark; ///< what differs between the recorded plan and the one of this version; empty = nothing
    /// Time between two trials for journal and choice of the next step; with and without waiting for the disk.
    std::vector<double> bookkeeping_ms, unsynced_ms;
};

/// @throws ScriptError, as run_session, if this session of the participant exists already, or the folder has
/// sessions of another script
void check_is_new(std::string const& participant_id, SessionSettings const& settings);

/// Runs a session; resumed ones with the plan that was recorded (session_plan.h). Its folder gets plan.tsv (the
/// whole order, before the first trial), journal.jsonl (the authoritative record) and session.json (a summary).
/// @throws ScriptError if the session cannot start or resume, with nothing written: it exists already, another
/// process runs it, it or other sessions in the folder have another script, the display fails the test that the
/// script requires; also if the disk fails, after which the journal has all earlier entries
SessionOutcome run_session(Script const& script, int participant, Presenter& presenter,
                           SessionSettings const& settings);

} // namespace study
