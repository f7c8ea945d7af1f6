#pragma once
#include "gi/scene/load/yaml_reader.h"
#include "gi/scene/model/scene.h"

namespace gi {

/// Adds a punctual light with its node, or an emissive mesh for a rectangle light.
void add_scene_file_light(YamlReader const& light, Scene& scene);

} // namespace gi
