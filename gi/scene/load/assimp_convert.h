#pragma once
#include "gi/core/report.h"
#include "gi/scene/model/scene.h"

#include <filesystem>

struct aiScene;

namespace gi {

/// Converts nodes, meshes, materials, bones, clips, cameras and lights.
/// @param file textures are searched beside it
Scene convert_assimp(aiScene const& source, std::filesystem::path const& file, Report& report);

} // namespace gi
