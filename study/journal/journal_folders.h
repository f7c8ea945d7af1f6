#pragma once
// Locations of the journals of a data set (BIDS): DIR/sub-ID/ses-01/beh/journal.jsonl

#include <filesystem>
#include <string>
#include <vector>

namespace study {

/// DIR/sub-ID/ses-01/beh. @throws ScriptError if the id has characters other than letters and digits, or the
/// session is not 1 to 99
std::filesystem::path session_folder(std::filesystem::path const& dir, std::string const& participant_id,
                                     int session);

struct JournalsFound {
    std::vector<std::filesystem::path> files; ///< by folder: participant, then session
    std::vector<std::string> remarks;         ///< participants and sessions without a journal
};

/// Finds the journals in all folders sub-*/ses*, even with invalid names; empty if `dir` does not exist.
/// @throws ScriptError if a folder cannot be read
JournalsFound find_journals(std::filesystem::path const& dir);

/// Names in a folder that begin with `prefix`, sorted; empty if the folder does not exist.
/// @throws ScriptError if it cannot be read
std::vector<std::filesystem::path> names_in(std::filesystem::path const& folder, std::string const& prefix);

} // namespace study
