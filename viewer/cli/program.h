#pragma once
// Builds the command line of a program from its commands, and runs it.

#include <span>
#include <string_view>

namespace CLI {
class App;
}

namespace viewer {

/// A command that this program implements.
struct AddedCommand {
    std::string_view name; ///< as in command_table.h
    void (*add)(CLI::App& parent, int& exit_code);
};

struct CommandRow;
/// Adds a command of another program to --help. Calling it throws InputError, which names that program.
void add_elsewhere(CLI::App& parent, CommandRow const& command);

/// Parses and runs the whole command line.
/// @param own  commands that this program implements; all others appear only in --help
/// @return exit code: 0 done, 1 a comparison or an output failed, or an internal error, 2 invalid input or call,
/// 130 interrupted (results so far are kept)
int run_program(int argc, char const* const* argv, std::span<AddedCommand const> own);

} // namespace viewer
