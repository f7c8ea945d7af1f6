#pragma once
// What every bench command does at its beginning and at its end.

#include "viewer/report/table.h"

namespace viewer {

/// An empty table that knows program, command, machine and date.
BenchTable start_table(std::string const& name, std::string const& title, std::vector<std::string> const& columns);

/// Throws InputError unless the folder is there, or can be made, and tables can be written to it. Makes nothing.
void check_folder(std::string const& folder);

/// On stdout: the rows and the names of their files, or all of it as JSON.
void show(BenchTable const& table, std::string const& folder, bool json);

} // namespace viewer
