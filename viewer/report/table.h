#pragma once
// Rows of measurements with named columns, and what is needed to believe and repeat them.
// Names of columns are snake_case and end in their unit: "frame_s", "rays_per_s", "memory_bytes".

#include "viewer/report/machine.h"
#include "viewer/report/measure.h"

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace viewer {

/// Nothing, a text, a number, or a number with its spread.
using Cell = std::variant<std::monostate, std::string, double, Measured>;

struct BenchTable {
    std::string name; ///< of its files: letters, digits, '-', '_'
    std::vector<std::string> columns;
    std::string title{}, program{}, command{}, date{};
    Machine machine{};
    std::vector<std::pair<std::string, std::string>> facts{}; ///< "bounces", "64"; what one row cannot say
    std::vector<std::vector<Cell>> rows{};                    ///< as many cells each as there are columns

    /// One row; throws std::logic_error where it has not a cell per column.
    void add(std::vector<Cell> row);
    /// -1 where there is no such column.
    int column(std::string const& column_name) const;
};

/// Nothing where the column is not there.
Cell const& cell(BenchTable const& table, std::vector<Cell> const& row, std::string const& column_name);
/// NaN where it is no number; the median where it was measured.
double number(Cell const& cell);
/// For people: "0.1013 (0.1002 to 0.105)", four digits.
std::string to_text(Cell const& cell);
/// Names of files are for programs, and stay out of what people read.
bool names_file(std::string const& column_name);

/// Aligned text, spreads as +-half of their width; columns of names of files are left out.
std::string to_text(BenchTable const& table);
void print(BenchTable const& table);

} // namespace viewer
