#pragma once
#include <string>
#include <vector>

namespace viewer {

/// Finds out before the work whether its results can be kept. Empty names are left out. Throws InputError where a
/// folder is missing or read-only, where a name is anything but a regular file (a device would be replaced), where
/// two outputs are one file, and where one would overwrite `input`.
void check_outputs(std::vector<std::string> const& files, std::vector<std::string> const& inputs);

} // namespace viewer
