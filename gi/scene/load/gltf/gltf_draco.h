#pragma once
#include "gi/scene/load/gltf/gltf_accessor.h"

namespace gi {

/// What KHR_draco_mesh_compression holds of a primitive. Integers are normalised where the accessor says so.
struct DracoMesh {
    std::vector<uvec3> triangles;
    std::map<std::string, GltfArray> attributes; ///< by glTF's names ("POSITION", ...)
};

/// Throws InputError on damaged data.
DracoMesh decode_draco(GltfDocument& document, tinygltf::Primitive const& primitive, std::string const& where);

} // namespace gi
