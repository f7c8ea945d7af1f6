#pragma once
// Tables of other programs: comma-, semicolon- or tab-separated text with a line of column names (RFC 4180: cells
// in quotes may contain separators, line ends and doubled quotes), in UTF-8. A byte-order mark is ignored, as are
// empty lines; lines end in LF, CR LF, or CR if there is no LF.

#include "study/script/script_error.h"

#include <string>
#include <vector>

namespace study {

struct TextCell {
    std::string text{}; ///< without surrounding blanks
    Place place{};      ///< of its first character
    int file = 0;       ///< of DelimitedText::files
};
struct DelimitedText {
    std::string file;               ///< name in messages
    std::vector<std::string> files; ///< where cells come from
    std::vector<std::string> columns;
    std::vector<std::vector<TextCell>> rows; ///< each with one cell per column; empty lines are ignored

    /// @return -1 = there is none
    int column(std::string const& name) const;
    /// Cells that stand for a missing value: "", "NA", "n/a", "nan", "None".
    static bool is_missing(std::string const& text);
};

/// Rows of several tables one after another, such as one file per participant;
/// columns that a table does not have are empty there.
DelimitedText joined(std::vector<DelimitedText> const& tables);
/// One row per trial from a table with one row per value: all rows that agree in the other columns become one row,
/// with a column for each name in `names` that has the text in `values`.
/// @throws ScriptError unknown columns, a name that occurs twice in a trial
DelimitedText to_wide(DelimitedText const& table, std::string const& names, std::string const& values);

/// The separator is the one of comma, semicolon and tab that is most frequent in the line of column names.
/// @throws ScriptError text that is not UTF-8 or has zero bytes, no columns, two with the same name, a row with
/// another number of cells, an open quote
DelimitedText read_delimited(std::string text, std::string const& file);

} // namespace study
