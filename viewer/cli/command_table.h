#pragma once
// Every command with its program: `lightwell` shows all of them and becomes the one that is called.

#include <span>
#include <string>
#include <string_view>

namespace viewer {

struct CommandRow {
    std::string_view name;    ///< "render", or "study run" within a group
    std::string_view program; ///< its file, beside `lightwell`
    std::string_view about;   ///< one line of --help
};

std::span<CommandRow const> commands();
/// The line of --help of a command that is in the table.
std::string about(std::string_view name);
/// The file that has the command which these first two arguments call; empty = none.
std::string_view program_of(std::string_view first, std::string_view second);

} // namespace viewer
