#pragma once
#include "gi/scene/model/scene.h"

namespace gi {

/// A skinned mannequin, 1.75 m tall, facing +Z of its root, with the clip "walk" (1.2 s, two steps, in place,
/// looping). Adds materials, a mesh, a skin, nodes and the playback. @param detail segments around a limb are 20 *
/// detail
void add_figure(Scene& scene, dmat4 const& world_from_root, double detail);

} // namespace gi
