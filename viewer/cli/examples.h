#pragma once
// Examples in the text behind the options of --help: lines of "  lightwell COMMAND ...", under "Examples:" those of the
// command itself or its subcommands, before them, under "Prepared by:", what makes their inputs.

#include <string>

namespace CLI {
class App;
}

namespace viewer {

/// Subcommands without such a text have that of a command above them, which CLI11 copies: they get the examples of the
/// command above that call them, and nothing if none does.
void keep_own_examples(CLI::App& program);

} // namespace viewer
