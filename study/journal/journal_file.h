#pragma once
// Reads the file of a session's journal, even one that ends within a line.

#include "study/journal/entries.h"

#include <filesystem>
#include <string_view>

namespace study {

/// Content of a journal file. While a session runs, the file ends with empty lines, space preallocated for further
/// entries. A killed process, a full disk or a power failure can leave an incomplete last line: it belongs to an
/// unfinished step, is ignored, and its bytes are counted.
struct JournalText {
    SessionRecord record;
    std::size_t good_bytes = 0; ///< of complete lines
    std::size_t torn_bytes = 0; ///< after them, of an incomplete line
    std::size_t room_bytes = 0; ///< after that, of empty lines
};

/// @param name name of the text in messages
/// @throws ScriptError with the line for any error except an incomplete last line: lines that are missing or were
/// changed, entries of a newer version
JournalText parse_journal(std::string_view text, std::string const& name);

/// @throws ScriptError as parse_journal, and if the file cannot be read
JournalText read_journal(std::filesystem::path const& file);

} // namespace study
