#pragma once
// Where the journals of a data set lie (BIDS): DIR/sub-ID/ses-01/beh/journal.jsonl

#include <filesystem>
#include <string>
#include <vector>

namespace study {

/// DIR/sub-ID/ses-01/beh. @throws ScriptError where the id has anything but letters and digits, or the session is
/// not 1 to 99
std::filesystem::path session_folder(std::filesystem::path const& dir, std::string const& participant_id,
                                     int session);

struct JournalsFound {
    std::vector<std::filesystem::path> files; ///< by folder: participant, then session
    std::vector<std::string> remarks;         ///< participants and sessions without a journal
};

/// Those of all folders sub-* and ses* in them, whether or not they are named rightly; none where there is no such
/// folder. @throws ScriptError where one of them cannot be read
JournalsFound find_journals(std::filesystem::path const& dir);

/// Names in a folder that begin with `prefix`, sorted; none where there is no such folder.
/// @throws ScriptError where it cannot be read
std::vector<std::filesystem::path> names_in(std::filesystem::path const& folder, std::string const& prefix);

} // namespace study
