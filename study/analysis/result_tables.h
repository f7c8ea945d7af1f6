#pragma once
// An analysis as tables: for the terminal, for CSV and JSON, for the report.

#include "study/analysis/analysis.h"
#include "study/tables/table.h"

namespace study {

struct ResultTable {
    std::string name; ///< of files and JSON: "scores"
    std::string title, note;
    bool is_long = false; ///< too long for a terminal
    Table table;
};

/// Those that have rows. What each number is stands in the columns' descriptions.
std::vector<ResultTable> result_tables(Analysis const& analysis);

/// A cell for people: four digits, "<0.001" of small probabilities (columns named p or p_...), "–" for n/a.
std::string shown_cell(Column const& column, std::string const& cell);
/// Aligned columns with their names above, a title and a note; long ones are only named.
std::string to_text(Analysis const& analysis);
/// Everything, numbers as numbers, null where there is none; the tracks of staircases and the matrices of wins
/// too.
std::string to_json(Analysis const& analysis);

} // namespace study
