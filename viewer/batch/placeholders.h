#pragma once
// {name} in texts of a manifest is replaced by the value of a parameter; {{ and }} are braces.

#include "gi/core/yaml.h"
#include "viewer/batch/task.h"

namespace viewer::batch {

/// @throws InputError at the place of `where`: an unknown parameter, or braces that do not pair
std::string filled_in(std::string const& text, std::vector<Parameter> const& parameters, gi::Yaml const& where);

} // namespace viewer::batch
