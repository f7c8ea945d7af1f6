#pragma once
// Parts of a scene file that have readers of their own.

#include "gi/core/yaml.h"
#include "gi/scene/model/scene.h"

namespace gi {

/// Sets the values given in one override of a scene file; other values are kept.
void change_material(Yaml const& values, Material& m);

/// Adds a punctual light with its node, or an emissive mesh for a rectangle light.
void add_scene_file_light(Yaml const& light, Scene& scene);

/// Applies the `animation` of a model: none, the name of a clip, a clip with speed, offset, loop and weight, or a
/// list of clips to blend (Playback).
void choose_animation(Yaml const& animation, Scene& part);

} // namespace gi
