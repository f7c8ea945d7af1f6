#pragma once
// Tables on disk: NAME.json with everything, NAME.csv with the rows for a spreadsheet.
//
// JSON: {"lightwell_table": 1, "name", "title", "program", "command", "date", "machine": {"cpu", "cores",
// "memory_gib"}, "facts": {..}, "columns": [..], "rows": [[cell, ..], ..]}; a cell is null, a text, a number, or
// {"median", "min", "max", "repeats"}. Numbers that are not finite are null.
// CSV (RFC 4180): a measured column becomes NAME, NAME_min, NAME_max, NAME_repeats.

#include "viewer/report/table.h"

#include <filesystem>

namespace viewer {

std::string to_json(BenchTable const& table);
std::string to_csv(BenchTable const& table);
/// Writes both files, atomically by renaming.
void write(BenchTable const& table, std::filesystem::path const& folder);

/// Throws InputError if the text is not a table. @param name  for messages
BenchTable parse_table(std::string const& json, std::string const& name);

} // namespace viewer
