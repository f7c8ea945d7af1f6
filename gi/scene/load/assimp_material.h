#pragma once
#include "gi/core/report.h"
#include "gi/scene/load/assimp_types.h"
#include "gi/scene/model/scene.h"

#include <filesystem>

namespace gi {

/// Materials with their textures, embedded ones or files beside the scene in `folder`.
void convert_materials(aiScene const& source, std::filesystem::path const& folder, Scene& scene, Report& report);

} // namespace gi
