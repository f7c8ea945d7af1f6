#pragma once
// Loads the script of an experiment, for commands and Python.

#include "study/script/script_file.h"

#include <filesystem>
#include <string>
#include <vector>

namespace viewer {

struct LoadedScript {
    study::Script script;
    std::string text;             ///< the whole file
    std::filesystem::path folder; ///< folder of the script and its Markdown files
};
/// Throws ScriptError or InputError if the script or a Markdown file that it names cannot be read.
LoadedScript load_script(std::string const& file);
/// A script as far as it can be read, and what is wrong with it or with the Markdown files that it names.
struct ScriptToCheck {
    LoadedScript loaded;
    study::Mistakes mistakes;
    bool is_whole = false; ///< false: it is not YAML, or no map
};
/// Throws InputError only if the file cannot be read.
ScriptToCheck load_script_to_check(std::string const& file);
/// Parses "3", "1..24" or "1,4,7..9"; empty = all. Returns each number once, in rising order. Throws InputError on
/// numbers outside of 1 to count.
std::vector<int> parse_participants(std::string const& text, int count);

void print_doubts(std::vector<std::string> const& doubts); ///< on stderr, one line each

} // namespace viewer
