#pragma once
#include "gi/core/yaml.h"
#include "gi/scene/model/scene.h"

namespace gi {

/// A punctual light with its node, or for a rectangle an emissive mesh.
void add_scene_file_light(Yaml const& light, Scene& scene);

} // namespace gi
