#include "viewer/cli/examples.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <vector>

namespace viewer {
namespace {

std::string examples_of(std::string const& path, std::string const& text)
{
    std::istringstream in(text);
    std::string own;
    for (std::string line; std::getline(in, line);)
        if ((line + " ").starts_with("  lightwell " + path + " ")) own += "\n" + line;
    return own.empty() ? own : "Examples:" + own;
}

/// @param path  of the command: "" or "display"  @param above  texts of all commands above it
void keep_own(CLI::App& command, std::string const& path, std::vector<std::string> above)
{
    above.push_back(command.get_footer());
    for (CLI::App* const sub : command.get_subcommands([](CLI::App*) { return true; })) {
        std::string const name = path.empty() ? sub->get_name() : path + " " + sub->get_name();
        keep_own(*sub, name, above);
        if (std::ranges::find(above, sub->get_footer()) != above.end())
            sub->footer(examples_of(name, above.back()));
    }
}

} // namespace

void keep_own_examples(CLI::App& program) { keep_own(program, "", {}); }

} // namespace viewer
