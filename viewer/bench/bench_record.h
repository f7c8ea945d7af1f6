#pragma once
// Start and end of every bench command.

#include "viewer/report/table.h"

namespace viewer {

/// Returns an empty table with program, command, machine and date.
BenchTable start_table(std::string const& name, std::string const& title, std::vector<std::string> const& columns);

/// Throws InputError unless the folder exists or can be created, and is writable. Creates nothing.
void check_folder(std::string const& folder);

/// Prints the rows and the names of the table's files on stdout, or the whole table as JSON.
void show(BenchTable const& table, std::string const& folder, bool json);

} // namespace viewer
