#pragma once
// Manual pages, made from what --help knows.

#include <string>

namespace CLI {
class App;
}

namespace viewer {

/// Environment variable of a call that writes the manual pages of a program's commands into this folder.
inline constexpr char const* kManVariable = "LIGHTWELL_MAN";

/// A page (roff, man macros) of a command and all its subcommands.
/// @param name  "lightwell render"  @param version  "lightwell 0.1.0 (git 1a2b3c4)"
std::string man_page(CLI::App const& command, std::string const& name, std::string const& version);

} // namespace viewer
