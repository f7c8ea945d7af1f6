#pragma once
#include "gi/scene/load/gltf/gltf_mesh.h"

namespace gi {

/// Reads nodes (parents before children), skins, cameras and lights. Nodes outside the file's default scene are
/// kept because they may be joints, but without meshes, cameras or lights. Throws InputError if nodes form a loop
/// or have two parents.
/// @return for each node of the file, its index in the scene
std::vector<std::int32_t> read_nodes(GltfDocument& document, std::vector<GltfMesh> const& meshes, Scene& scene,
                                     Report& report);

} // namespace gi
