#pragma once
// Reads the key `real:` of a session file: the modelled part of the real place.

#include "ar/scene/session_file.h"
#include "gi/scene/load/yaml_reader.h"

namespace viewer {

/// @throws gi::InputError with file:line:column
ArReal read_real(gi::YamlReader const& real, std::filesystem::path const& folder);

} // namespace viewer
