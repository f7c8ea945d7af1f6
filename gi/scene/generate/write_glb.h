#pragma once
// Saves scenes as binary glTF 2.

#include "gi/core/report.h"
#include "gi/scene/model/scene.h"

#include <filesystem>
#include <vector>

namespace gi {

/// Saves a scene as binary glTF 2 (by rename): nodes, meshes, materials with their KHR extensions, textures (PNG),
/// skins, morph targets, clips, cameras, lights. Phong materials store their values in extras.lightwell_phong.
/// Anything that glTF cannot store (the environment map) is counted as a loss.
void write_glb(std::filesystem::path const& file, Scene const& scene, Report& report);

/// First line of the F.yaml of a bundle.
inline constexpr char const* kBundleMark = "# Made by lightwell generate.";

/// Returns the files that write_scene_bundle writes, in order.
std::vector<std::filesystem::path> scene_bundle_files(std::filesystem::path const& glb, Scene const& scene);

/// Same as write_glb; if the scene has an environment map, also writes F_sky.exr, and F.yaml, which combines both.
/// @return the files, in the order they were written
std::vector<std::filesystem::path> write_scene_bundle(std::filesystem::path const& glb, Scene const& scene,
                                                      Report& report);

} // namespace gi
