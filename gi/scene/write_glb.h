#pragma once
#include "gi/base/report.h"
#include "gi/scene/scene.h"

#include <filesystem>

namespace gi {

/// Save a scene as binary glTF 2 (by rename): nodes, meshes, materials with their KHR extensions, textures (PNG),
/// skins, morph targets, clips, cameras, lights. What glTF cannot hold (environment map, phong) is counted as lost.
void write_glb(std::filesystem::path const& file, Scene const& scene, Report& report);

} // namespace gi
