#pragma once
#include "gi/core/yaml.h"
#include "gi/scene/model/material.h"

namespace gi {

/// The values that one override of a scene file names; the others stay.
void change_material(Yaml const& values, Material& m);

} // namespace gi
