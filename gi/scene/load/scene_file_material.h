#pragma once
#include "gi/core/yaml.h"
#include "gi/scene/model/material.h"

namespace gi {

/// Sets the values given in one override of a scene file; other values are kept.
void change_material(Yaml const& values, Material& m);

} // namespace gi
