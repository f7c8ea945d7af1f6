#pragma once
// Tables of other programs: text separated by commas, semicolons or tabs, with a line of column names (RFC 4180: cells
// in quotes may contain separators, line ends and doubled quotes). Lines end in LF, CR LF or CR. Ignored are a
// byte-order mark, empty lines, "sep=;" in the first line (spreadsheets), and, counted, lines of comments that begin
// with '#' and further lines of column names, as in files that were joined. Columns may have equal names, which then
// cannot be named.

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
    std::string separators;         ///< of each file
    std::vector<std::string> columns;
    std::vector<TextCell> heads;             ///< the cells that name them
    std::vector<std::string> notes{};        ///< what was skipped, and what is uncertain
    std::vector<std::vector<TextCell>> rows; ///< each with one cell per column; empty lines are ignored

    /// @return the first of that name; -1 = there is none
    int column(std::string const& name) const;
    /// @throws ScriptError there are two of that name
    void check_one_column(std::string const& name) const;
    /// Cells that stand for a missing value: "", "NA", "n/a", "nan", "None", "--", ".", "#N/A", ...
    static bool is_missing(std::string const& text);
};

/// Rows of several tables one after another, such as one file per participant;
/// columns that a table does not have are empty there. Of columns with equal names the first ones belong together, the
/// second ones, and so on.
/// @throws ScriptError two tables with the same cells: a file that is given twice
DelimitedText joined(std::vector<DelimitedText> const& tables);
/// The table with a last column `file`: the name of each row's file without folder and ending, as far as these names differ.
DelimitedText with_file_names(DelimitedText const& table);
/// A short name: "young", "young and old", "young and 9 others".
std::string label_of(DelimitedText const& table);
/// One row per trial from a table with one row per value: all rows that agree in the other columns become one row,
/// with a column for each name in `names` that has the text in `values`.
/// @throws ScriptError unknown columns, a name that occurs twice in a trial, more than 1000 names, or a wide table of
/// ten times the cells of the long one
DelimitedText to_wide(DelimitedText const& table, std::string const& names, std::string const& values);

/// The separator is the one of comma, semicolon and tab that is most frequent in the line of column names; of two, the one
/// that is as frequent in the next line. That line may
/// begin with "# ". Rows may end before the last columns, which are missing there.
/// @throws ScriptError as decoded_table; no columns, a row with more cells or with only one, a further line of column
/// names in another order, an open quote
DelimitedText read_delimited(std::string text, std::string const& file);

} // namespace study
