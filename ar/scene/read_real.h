#pragma once
// The part `real:` of a session file: what of the place is modelled.

#include "ar/scene/session_file.h"
#include "gi/scene/load/yaml_reader.h"

namespace viewer {

/// @throws gi::InputError with file:line:column
ArReal read_real(gi::YamlReader const& real, std::filesystem::path const& folder);

} // namespace viewer
