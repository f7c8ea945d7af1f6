#pragma once
// Tables on disk: NAME.json holds everything, NAME.csv the rows for a spreadsheet.
//
// JSON: {"lightwell_table": 1, "name", "title", "program", "command", "date", "machine": {"cpu", "cores",
// "memory_gib"}, "facts": {..}, "columns": [..], "rows": [[cell, ..], ..]}; a cell is null, a text, a number, or
// {"median", "min", "max", "repeats"}. Numbers that are not finite are null.
// CSV (RFC 4180): a column with a spread becomes NAME, NAME_min, NAME_max, NAME_repeats.

#include "viewer/report/table.h"

#include <filesystem>

namespace viewer {

std::string to_json(BenchTable const& table);
std::string to_csv(BenchTable const& table);
/// Both files, by rename.
void write(BenchTable const& table, std::filesystem::path const& folder);

/// `name` is used in messages. Throws InputError on what is no table.
BenchTable parse_table(std::string const& json, std::string const& name);

} // namespace viewer
