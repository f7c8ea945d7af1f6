#pragma once
// Rows of measurements with named columns, and what is needed to check and repeat them.
// Column names are snake_case and end in their unit: "frame_s", "rays_per_s", "memory_bytes".

#include "viewer/report/machine.h"
#include "viewer/report/measure.h"

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace viewer {

/// Empty, a text, a number, or a measured number with its range.
using Cell = std::variant<std::monostate, std::string, double, Measured>;

struct BenchTable {
    std::string name; ///< file name: letters, digits, '-', '_'
    std::vector<std::string> columns;
    std::string title{}, program{}, command{}, date{};
    MachineFacts machine{};
    std::vector<std::pair<std::string, std::string>> facts{}; ///< e.g. "bounces", "64"; facts about all rows
    std::vector<std::vector<Cell>> rows{};                    ///< each with one cell per column

    /// Adds a row; throws std::logic_error unless it has one cell per column.
    void add(std::vector<Cell> row);
    /// Index of a column; -1 if there is none.
    int column(std::string const& column_name) const;
};

/// Cell of a row in a column; empty if there is no such column.
Cell const& cell(BenchTable const& table, std::vector<Cell> const& row, std::string const& column_name);
/// Number in a cell: the median if measured, NaN if it is not a number.
double number(Cell const& cell);
/// Readable text with four digits: "0.1013 (0.1002 to 0.105)".
std::string to_text(Cell const& cell);
/// True if a column holds texts, not numbers.
bool holds_text(BenchTable const& table, std::size_t column);
/// True if a column holds file names, which are left out of readable tables.
bool names_file(std::string const& column_name);

/// Aligned text, with ranges as +- half their width; columns of file names are left out.
std::string to_text(BenchTable const& table);
void print(BenchTable const& table);

} // namespace viewer
