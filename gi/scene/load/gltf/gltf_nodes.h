#pragma once
#include "gi/scene/load/gltf/gltf_mesh.h"

namespace gi {

/// Nodes with parents before children, skins, cameras and lights. Nodes outside the scene that the file shows keep
/// their place, as joints may be among them, but nothing hangs on them. Throws InputError on loops and on second
/// parents.
/// @return where each node of the file went
std::vector<std::int32_t> read_nodes(GltfDocument& document, std::vector<GltfMesh> const& meshes, Scene& scene,
                                     Report& report);

} // namespace gi
