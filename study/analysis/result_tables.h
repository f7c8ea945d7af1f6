#pragma once
// An analysis as tables, for the terminal, CSV, JSON and the report.

#include "study/analysis/analysis.h"
#include "study/tables/result_table.h"

#include <span>

namespace study {

/// The tables of an analysis, without those that are empty. What each number means is in Column::description.
std::vector<ResultTable> result_tables(Analysis const& analysis);

/// Tables with aligned columns, column names, a title and a note; long tables are only named.
std::string tables_text(std::span<ResultTable const> tables);
/// The same of an analysis.
std::string to_text(Analysis const& analysis);
/// The whole analysis as JSON, with numbers as numbers and null = missing; includes the tracks of staircases and
/// the matrices of wins.
std::string to_json(Analysis const& analysis);

} // namespace study
