#pragma once
#include "gi/core/yaml.h"

#include <string>

namespace viewer {

/// JSON, with the place of every value. Throws InputError, with file:line:column, on other text.
/// @param root  the name of the whole in messages
gi::Yaml parse_placed_json(std::string const& text, std::string const& file, std::string const& root);

} // namespace viewer
