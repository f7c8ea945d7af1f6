#pragma once
#include "gi/scene/load/yaml_reader.h"
#include "gi/scene/model/material.h"

namespace gi {

/// Sets the values given in one override of a scene file; other values are kept.
void change_material(YamlReader const& values, Material& m);

} // namespace gi
