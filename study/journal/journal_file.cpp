#include "study/journal/journal_file.h"

#include "gi/core/checked_line.h"
#include "gi/core/file.h"
#include "study/journal/entry_line.h"
#include "study/script/script_error.h"

#include <algorithm>

namespace study {
namespace {

/// True for an incomplete last line: its end is missing, or after a power failure parts of it still have the zeros
/// or empty lines of the preallocated space.
bool is_torn(std::string_view line) { return !gi::has_checksum(line) || line.find('\0') != std::string_view::npos; }

} // namespace

JournalText parse_journal(std::string_view text, std::string const& name)
{
    JournalText out;
    // npos + 1 = 0: only empty lines.
    std::size_t const said = text.find_last_not_of('\n') + 1;
    while (out.good_bytes < said) {
        std::size_t const at = out.good_bytes, end = text.find('\n', at);
        if (end == std::string_view::npos) break;
        std::string_view const line = text.substr(at, end - at);
        bool const is_last = end >= said || text.find('\n', text.find_first_not_of('\n', at)) >= said;
        if (is_last && is_torn(line)) break;
        int const number = int(out.record.entries.size()) + 1;
        try {
            out.record.entries.push_back(entry_of_line(line, number));
        } catch (BadLine const& e) {
            throw ScriptError(name, {number, 1}, "this line of a journal cannot be read", e.what(),
                              e.is_newer() ? "a newer version wrote it: use that one"
                                           : "restore the file from a copy, nothing of it has been changed");
        }
        out.good_bytes = end + 1;
    }
    out.torn_bytes = std::max(said, out.good_bytes) - out.good_bytes;
    out.room_bytes = text.size() - out.good_bytes - out.torn_bytes;
    return out;
}

JournalText read_journal(std::filesystem::path const& file)
{
    return parse_journal(gi::read_text(file), file.string());
}

} // namespace study
