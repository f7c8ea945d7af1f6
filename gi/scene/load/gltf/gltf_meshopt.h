#pragma once
#include "gi/scene/load/gltf/gltf_document.h"

namespace gi {

/// A buffer view of EXT_meshopt_compression, decoded and its filter undone. Throws InputError on damaged data.
std::vector<unsigned char> decode_meshopt(GltfDocument& document, int view, tinygltf::Value const& extension);

} // namespace gi
