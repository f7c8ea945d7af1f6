#pragma once
// The part `real:` of a session file: what of the place is modelled.

#include "ar/scene/session_file.h"
#include "gi/core/yaml.h"

namespace viewer {

/// @throws gi::InputError with file:line:column
ArReal read_real(gi::Yaml const& real, std::filesystem::path const& folder);

} // namespace viewer
