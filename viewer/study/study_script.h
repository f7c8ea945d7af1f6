#pragma once
// The script of an experiment as commands and Python read it.

#include "study/script/script.h"

#include <filesystem>
#include <string>
#include <vector>

namespace viewer {

struct LoadedScript {
    study::Script script;
    std::string text;             ///< the whole file
    std::filesystem::path folder; ///< in which it lies, with its Markdown files
};
/// Throws ScriptError or InputError where the script or a Markdown file that it names cannot be read.
LoadedScript load_script(std::string const& file);
/// "3", "1..24" or "1,4,7..9"; empty = all. Rising, each once. Throws InputError where it names others than 1 to
/// count.
std::vector<int> parse_participants(std::string const& text, int count);

void print_doubts(std::vector<std::string> const& doubts); ///< on stderr, a line each

} // namespace viewer
