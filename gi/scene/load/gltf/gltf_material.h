#pragma once
#include "gi/scene/load/gltf/gltf_document.h"
#include "gi/scene/model/scene.h"

namespace gi {

/// Materials, and the textures that they use, into the scene. Factors out of range are clamped and counted;
/// textures that cannot be read are left out and counted.
void read_materials(GltfDocument& document, Scene& scene, Report& report);

} // namespace gi
