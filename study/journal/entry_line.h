#pragma once
// An entry of a journal as one line of JSON:
//   {"n":12,"kind":"trial_done", the fields as entries.h names them, "crc32":"89abcdef"}
// n counts the lines of the file from 1. The checksum is the CRC-32 of gzip over the line up to `,"crc32"`.
// Numbers are written with as many digits as bring back the same double; those that JSON does not have are the
// texts "nan", "inf" and "-inf". What is not there is null: a line has every field of its kind and no other. The
// first kind, session_started, has the format "journal/1" too.

#include "study/journal/entries.h"

#include <stdexcept>
#include <string>
#include <string_view>

namespace study {

/// Without the end of line. Text that is not UTF-8 has U+FFFD in its place.
std::string entry_line(JournalEntry const& entry, int number);

/// What is wrong with a line, and whether it seems whole but newer than this version.
class BadLine : public std::runtime_error {
public:
    BadLine(std::string const& why, bool is_newer) : std::runtime_error(why), is_newer_(is_newer) {}
    bool is_newer() const { return is_newer_; }

private:
    bool is_newer_;
};

/// Whether a line ends as all do that are whole.
bool has_checksum(std::string_view line);
/// @param number that the line must have
/// @throws BadLine where it is not what entry_line writes: no JSON, another checksum or number, fields that are
/// missing, unknown, or of another kind
JournalEntry entry_of_line(std::string_view line, int number);

} // namespace study
