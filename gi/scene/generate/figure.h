#pragma once
#include "gi/scene/model/scene.h"

namespace gi {

/// Adds a skinned mannequin, 1.75 m tall, facing +Z of its root, with the clip "walk" (1.2 s, two steps, in place,
/// looping): materials, a mesh, a skin, nodes and the playback.
/// @param detail a limb has 20 * detail segments around
void add_figure(Scene& scene, dmat4 const& world_from_root, double detail);

} // namespace gi
