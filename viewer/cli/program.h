#pragma once
#include <span>
#include <string_view>

namespace CLI {
class App;
}

namespace viewer {

/// A command that this program has itself.
struct AddedCommand {
    std::string_view name; ///< as in the table of commands
    void (*add)(CLI::App& parent, int& exit_code);
};

struct CommandRow;
/// A command of another program: for --help; calling it here says where it is (InputError).
void add_elsewhere(CLI::App& parent, CommandRow const& command);

/// The whole command line. @param own  what is done here; of the other commands only --help speaks
/// Exit codes: 0 done, 1 a comparison failed or something broke inside, 2 the input or the
/// call is wrong, 130 interrupted (what was done so far is kept).
int run_program(int argc, char const* const* argv, std::span<AddedCommand const> own);

} // namespace viewer
