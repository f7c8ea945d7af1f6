#pragma once
// Reads the key `real:` of a session file: the modelled part of the real place.

#include "ar/scene/session_file.h"
#include "gi/core/yaml.h"

namespace viewer {

/// @throws gi::InputError with file:line:column
ArReal read_real(gi::Yaml const& real, std::filesystem::path const& folder);

} // namespace viewer
