#pragma once
// Displays in YAML: data/display.schema.json has the keys, data/displays the examples. Every length, angle and
// time has its unit in its key.

#include "gi/core/report.h"
#include "viewer/displays/display.h"

#include <filesystem>
#include <string>

namespace viewer {

/// Throws InputError with file:line:column on what is no sound display; counts doubts in the report.
Display load_display(std::filesystem::path const& file, gi::Report& report);
/// As above from text; meshes are looked for beside `name`, which messages call it.
Display parse_display(std::string const& text, std::string const& name, gi::Report& report);

/// YAML that parses to an equal display. Meshes that came from a file are named, not written.
std::string to_yaml(Display const& display);
void save_display(std::filesystem::path const& file, Display const& display);

} // namespace viewer
