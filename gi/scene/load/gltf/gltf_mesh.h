#pragma once
// Reads the meshes of a glTF file, with morph targets.

#include "gi/scene/load/gltf/gltf_document.h"
#include "gi/scene/model/scene.h"

namespace gi {

/// One glTF mesh: its primitives with triangles.
struct GltfMesh {
    std::vector<std::int32_t> meshes; ///< indices into Scene::meshes
    std::size_t morph_targets = 0;
    std::vector<float> weights; ///< default morph weights, one per target
    std::uint32_t joints = 0;   ///< minimum number of joints of a skin for this mesh
};

/// Reads all meshes, in file order. Points and lines are counted as losses.
std::vector<GltfMesh> read_meshes(GltfDocument& document, Scene& scene, Report& report);

} // namespace gi
