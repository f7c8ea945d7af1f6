#pragma once
#include <string>
#include <vector>

namespace viewer {

/// Finds out before the work whether its results can be kept. Empty names are left out. Throws InputError where a
/// folder is missing or read-only, where a name is anything but a regular file (a device would be replaced), where
/// two outputs are one file, and where one would overwrite `input`.
void check_outputs(std::vector<std::string> const& files, std::vector<std::string> const& inputs);

/// Throws InputError where a name ends as something else than what is written. Without an ending all names fit.
/// @param ending  ".exr", in any case
/// @param what  "an OpenEXR picture"
void check_ending(std::string const& file, std::string const& ending, std::string const& what,
                  std::string const& suggestion);

} // namespace viewer
