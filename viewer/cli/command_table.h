#pragma once
// Table of all commands and their programs. `lightwell` lists all of them and executes the program of a command.

#include <span>
#include <string>
#include <string_view>

namespace viewer {

struct CommandRow {
    std::string_view name;    ///< "render", or "study run" within a group
    std::string_view program; ///< file name, in the folder of `lightwell`
    std::string_view about;   ///< one line of --help
};

std::span<CommandRow const> commands();
/// One-line help of a command in the table.
std::string about(std::string_view name);
/// Program of the command that the first two arguments name; empty if none.
std::string_view program_of(std::string_view first, std::string_view second);

} // namespace viewer
