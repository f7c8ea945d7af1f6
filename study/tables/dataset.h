#pragma once
// All sessions of an experiment in one folder.

#include "study/tables/recorded_session.h"

#include <filesystem>

namespace study {

struct Dataset {
    Script script;
    std::string script_text;
    std::vector<RecordedSession> sessions; ///< by folder: participant, then session
    std::vector<std::string> remarks;      ///< folders without a journal, lines that are not whole, and such
};

/// Reads DIR/sub-*/ses-*/beh/journal.jsonl, and plans each session anew.
/// @param script file; empty = DIR/code/*.yaml, the one with which the sessions were recorded
/// @throws ScriptError where there is no session, no script, a journal is of another script, broken or in the
/// folder of another session, or something cannot be read
Dataset read_dataset(std::filesystem::path const& dir, std::filesystem::path const& script);

/// Where read_dataset looks for the script: DIR/code/ID.yaml.
std::filesystem::path kept_script(std::filesystem::path const& dir, Script const& script);

} // namespace study
