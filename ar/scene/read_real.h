#pragma once
// Reads the key `real:` of a session file: the modelled part of the real place.

#include "ar/scene/session_file.h"
#include "gi/core/yaml.h"

namespace ar {

/// @throws gi::InputError with file:line:column
RealPlace read_real(gi::Yaml const& real, std::filesystem::path const& folder);

} // namespace ar
