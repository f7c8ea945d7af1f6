#pragma once
#include "gi/core/yaml.h"
#include "gi/scene/model/scene.h"

namespace gi {

/// Adds a punctual light with its node, or an emissive mesh for a rectangle light.
void add_scene_file_light(Yaml const& light, Scene& scene);

} // namespace gi
