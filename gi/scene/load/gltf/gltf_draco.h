#pragma once
// Decodes Draco-compressed meshes of glTF files (KHR_draco_mesh_compression).

#include "gi/scene/load/gltf/gltf_accessor.h"

namespace gi {

/// Decoded KHR_draco_mesh_compression data of a primitive. Integers of normalized accessors are normalised.
struct DracoMesh {
    std::vector<uvec3> triangles;
    std::map<std::string, GltfArray> attributes; ///< by glTF's names ("POSITION", ...)
};

/// Throws InputError on damaged data.
DracoMesh decode_draco(GltfDocument& document, tinygltf::Primitive const& primitive, std::string const& where);

} // namespace gi
