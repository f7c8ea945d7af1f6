#pragma once
#include "gi/scene/load/gltf/gltf_document.h"
#include "gi/scene/model/scene.h"

namespace gi {

/// Adds the materials and the textures that they use to the scene. Factors out of range are clamped and counted;
/// unreadable textures are left out and counted.
void read_materials(GltfDocument& document, Scene& scene, Report& report);

} // namespace gi
