#pragma once
#include "gi/core/yaml.h"
#include "gi/scene/model/scene.h"

namespace gi {

/// Applies the `animation` of a model: none, the name of a clip, a clip with speed, offset, loop and weight, or a
/// list of clips to blend (Playback).
void choose_animation(Yaml const& animation, Scene& part);

} // namespace gi
