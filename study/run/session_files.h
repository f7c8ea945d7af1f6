#pragma once
#include "study/run/journal.h"
#include "study/run/session.h"

#include <optional>

namespace study {

/// The files of a session that starts or resumes.
struct SessionFiles {
    std::filesystem::path folder;
    Journal journal;
    JournalText found; ///< earlier content of the journal
    bool is_new = false;
    std::filesystem::path first_made; ///< of a new session: the outermost folder created; empty = none

    /// Removes a new journal and the folders created for it, while nothing has happened yet.
    void discard();
};

/// @throws ScriptError as run_session does
SessionFiles open_session(std::string const& participant_id, SessionSettings const& settings);

/// @throws ScriptError if the record belongs to another experiment, participant, seed or script
void check_record(SessionRecord const& record, SessionStarted const& now, std::filesystem::path const& file);

} // namespace study
