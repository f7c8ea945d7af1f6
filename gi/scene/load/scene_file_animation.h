#pragma once
#include "gi/scene/load/yaml_reader.h"
#include "gi/scene/model/scene.h"

namespace gi {

/// Applies the `animation` of a model: none, the name of a clip, a clip with speed, offset, loop and weight, or a
/// list of clips to blend (Playback).
void choose_animation(YamlReader const& animation, Scene& part);

} // namespace gi
