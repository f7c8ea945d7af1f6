#pragma once
#include "study/journal/entries.h"

#include <filesystem>
#include <string_view>

namespace study {

/// A journal as it was found. While a session runs its file is longer than what it says: empty lines are room for
/// what comes. A process that was killed, a full disk or a loss of power can leave one line that is not whole, the
/// last: it is of something that had not been finished, and is left out and counted.
struct JournalText {
    SessionRecord record;
    std::size_t good_bytes = 0; ///< of whole lines
    std::size_t torn_bytes = 0; ///< after them, of one that is not whole
    std::size_t room_bytes = 0; ///< after that, empty lines
};

/// @param name of the text in messages
/// @throws ScriptError with the line where a journal has anything wrong but a torn end: lines that are missing or
/// were changed, entries of a newer version
JournalText parse_journal(std::string_view text, std::string const& name);

/// @throws ScriptError also where the file cannot be read
JournalText read_journal(std::filesystem::path const& file);

} // namespace study
