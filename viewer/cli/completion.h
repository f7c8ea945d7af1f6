#pragma once
// Completion of command lines by shells. A short script in the shell calls
// the program that has the command with the words so far, and offers what that prints:
// so completion knows what the program knows, and is never out of date.

#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace viewer {

/// Environment variable of a call that completes its last argument: prints one candidate a line.
inline constexpr char const* kCompleteVariable = "LIGHTWELL_COMPLETE";
/// Line that asks the shell for files.
inline constexpr char const* kFilesLine = ":files";

/// @param words  of the call, without the program; the last one is to be completed, and may be empty
std::vector<std::string> complete(CLI::App const& app, std::span<std::string const> words);

/// The script for a shell. @param shell  bash, zsh or fish
std::string completion_script(std::string const& shell);

} // namespace viewer
