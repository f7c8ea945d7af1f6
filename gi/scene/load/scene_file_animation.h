#pragma once
#include "gi/core/yaml.h"
#include "gi/scene/model/scene.h"

namespace gi {

/// What `animation` says of a model: none, the name of a clip, a clip with speed, offset, loop and weight, or a
/// list of such clips that are blended (Playback).
void choose_animation(Yaml const& animation, Scene& part);

} // namespace gi
