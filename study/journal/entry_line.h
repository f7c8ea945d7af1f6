#pragma once
// An entry of a journal as one line of JSON:
//   {"n":12,"kind":"trial_done", the fields as named in entries.h, "crc32":"89abcdef"}
// n is the line number, from 1; the checksum is that of gi/core/checked_line.h.
// Numbers are written with enough digits to restore the same double; non-finite ones are the strings "nan", "inf"
// and "-inf". Missing values are null: a line has every field of its kind and no other. The kind session_started
// also has the format "journal/1".

#include "study/journal/entries.h"

#include <stdexcept>
#include <string>
#include <string_view>

namespace study {

/// The line without line end. Invalid UTF-8 is replaced by U+FFFD.
std::string entry_line(JournalEntry const& entry, int number);

/// Error in a line; is_newer: the line seems complete but was written by a newer version.
class BadLine : public std::runtime_error {
public:
    BadLine(std::string const& why, bool is_newer) : std::runtime_error(why), is_newer_(is_newer) {}
    bool is_newer() const { return is_newer_; }

private:
    bool is_newer_;
};

/// @param number  expected number of the line
/// @throws BadLine if entry_line cannot have written it: no JSON, wrong checksum or number, fields that are
/// missing, unknown, or of another type
JournalEntry entry_of_line(std::string_view line, int number);

} // namespace study
