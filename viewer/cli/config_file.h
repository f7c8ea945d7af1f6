#pragma once
// A user's own default values of options:
//
//   render: {size: 640x480, threads: 2}
//   study run: {screen: 57}
//
// in $XDG_CONFIG_HOME/lightwell/config.yaml or ~/.config/lightwell/config.yaml; LIGHTWELL_CONFIG names another
// file, or "none". What the command line says comes first.

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace viewer {

/// The file that there is; empty = none. @throws InputError LIGHTWELL_CONFIG names a file that is not there
std::string config_file();

/// Inserts the options that the file adds to a call after the command's name.
/// @param app  with all commands; those of other programs may lack their options  @param words  the call, without
/// the program  @returns what was inserted
/// @throws InputError with its place: not YAML, no such command, no such option of this command
std::vector<std::string> add_configured_options(CLI::App const& app, std::string const& file,
                                                std::vector<std::string>& words);

} // namespace viewer
