#pragma once
#include "gi/scene/load/yaml_reader.h"
#include "gi/scene/model/material.h"

namespace gi {

/// The values that one override of a scene file names; the others stay.
void change_material(YamlReader const& values, Material& m);

} // namespace gi
