#pragma once
// Looks up commands and options as words of a command line name them.

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace viewer {

std::vector<CLI::App const*> subcommands(CLI::App const& app);
/// Null if there is none of that name.
CLI::App const* find_subcommand(CLI::App const& app, std::string const& name);
/// The option of "--size", "-o" or "--size=8x8"; null if there is none.
CLI::Option const* find_option(CLI::App const& app, std::string const& word);
/// "--out", or "-o" where that is its only name.
std::string longest_name(CLI::Option const& option);
/// Names of the options that --help lists, with dashes.
std::vector<std::string> option_names(CLI::App const& app);

} // namespace viewer
