#pragma once
#include "gi/scene/load/gltf/gltf_document.h"

namespace gi {

/// Decodes a buffer view of EXT_meshopt_compression, including its filter. Throws InputError on damaged data.
std::vector<unsigned char> decode_meshopt(GltfDocument& document, int view, tinygltf::Value const& extension);

} // namespace gi
