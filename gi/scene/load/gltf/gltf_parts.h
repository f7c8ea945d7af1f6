#pragma once
// Parts of a glTF file: materials, meshes, nodes.

#include "gi/scene/load/gltf/gltf_document.h"
#include "gi/scene/model/scene.h"

namespace gi {

/// OPAQUE where it is none that is known.
AlphaMode alpha_mode(tinygltf::Material const& material);

/// Adds the materials and the textures that they use to the scene. Factors out of range are clamped and counted;
/// unreadable textures are left out and counted.
void read_materials(GltfDocument& document, Scene& scene, Report& report);

/// One glTF mesh: its primitives with triangles.
struct GltfMesh {
    std::vector<std::int32_t> meshes; ///< indices into Scene::meshes
    std::size_t morph_targets = 0;
    std::vector<float> weights; ///< default morph weights, one per target
    std::uint32_t joints = 0;   ///< minimum number of joints of a skin for this mesh
};

/// Reads all meshes, in file order. Points and lines are counted as losses.
std::vector<GltfMesh> read_meshes(GltfDocument& document, Scene& scene, Report& report);

/// Reads nodes (parents before children), skins, cameras and lights. Nodes outside the file's default scene are
/// kept because they may be joints, but without meshes, cameras or lights. Throws InputError if nodes form a loop
/// or have two parents.
/// @return for each node of the file, its index in the scene
std::vector<std::int32_t> read_nodes(GltfDocument& document, std::vector<GltfMesh> const& meshes, Scene& scene,
                                     Report& report);

} // namespace gi
