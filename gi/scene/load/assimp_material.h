#pragma once
#include "gi/core/report.h"
#include "gi/scene/load/assimp_types.h"
#include "gi/scene/model/scene.h"

#include <filesystem>

namespace gi {

/// Converts materials with their textures, which are embedded or files in `folder` beside the scene.
void convert_materials(aiScene const& source, std::filesystem::path const& folder, Scene& scene, Report& report);

} // namespace gi
