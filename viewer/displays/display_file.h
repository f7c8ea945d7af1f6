#pragma once
// Displays in YAML: data/display.schema.json lists the keys, data/displays has examples. The key of every length,
// angle and time includes its unit.

#include "gi/core/report.h"
#include "viewer/displays/display.h"

#include <filesystem>
#include <string>

namespace viewer {

/// Throws InputError with file:line:column if the display is invalid; reports doubtful values.
Display load_display(std::filesystem::path const& file, gi::Report& report);
/// As above, from text. `name` is used in messages, and meshes are searched relative to it.
Display parse_display(std::string const& text, std::string const& name, gi::Report& report);

/// YAML that parses to an equal display. Meshes from a file are written as the file's name.
std::string to_yaml(Display const& display);

} // namespace viewer
