#pragma once
// Checks of output files before any work starts.

#include <string>
#include <vector>

namespace viewer {

/// Checks before the work starts that its outputs can be written; empty names are skipped. Throws InputError if a
/// folder is missing or read-only, if a name exists and is not a regular file (a device would be replaced), if two
/// outputs are the same file, or if one would overwrite one of `inputs`.
void check_outputs(std::vector<std::string> const& files, std::vector<std::string> const& inputs);

/// Throws InputError if the file name has an extension other than `ending`. Names without an extension pass.
/// @param ending  e.g. ".exr"; case is ignored
/// @param what  what is written, for the message: "an OpenEXR picture"
void check_ending(std::string const& file, std::string const& ending, std::string const& what,
                  std::string const& suggestion);

} // namespace viewer
