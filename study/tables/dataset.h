#pragma once
// All sessions of an experiment in one folder.

#include "study/tables/recorded_session.h"

#include <filesystem>

namespace study {

/// A file that was read.
struct InputFile {
    std::string file, sha256;
};

struct Dataset {
    Script script;
    std::string script_text;
    std::vector<RecordedSession> sessions; ///< by folder: participant, then session
    std::vector<std::string> remarks;      ///< such as folders without a journal, incomplete lines
    std::vector<InputFile> inputs{};       ///< script and journals, or tables
};

/// Reads DIR/sub-*/ses-*/beh/journal.jsonl with the recorded plan of each session. Where this version makes
/// another one, a remark says so.
/// @param script file; empty = DIR/code/*.yaml, the script with which the sessions were recorded
/// @throws ScriptError if there is no session or no script, a journal belongs to another script, is damaged or in
/// the folder of another session, its plan is lost, or a file cannot be read
Dataset read_dataset(std::filesystem::path const& dir, std::filesystem::path const& script);

/// File in which read_dataset looks for the script: DIR/code/ID.yaml.
std::filesystem::path kept_script(std::filesystem::path const& dir, Script const& script);

} // namespace study
