#pragma once
// Scenes to binary glTF 2.

#include "gi/core/report.h"
#include "gi/scene/model/scene.h"

#include <filesystem>
#include <vector>

namespace gi {

/// Save a scene as binary glTF 2 (by rename): nodes, meshes, materials with their KHR extensions, textures (PNG),
/// skins, morph targets, clips, cameras, lights. Phong materials keep their values in extras.lightwell_phong. What
/// glTF cannot hold (the environment map) is counted as lost.
void write_glb(std::filesystem::path const& file, Scene const& scene, Report& report);

/// First line of the F.yaml of a bundle.
inline constexpr char const* kBundleMark = "# Made by lightwell generate.";

/// The files that write_scene_bundle writes, in order.
std::vector<std::filesystem::path> scene_bundle_files(std::filesystem::path const& glb, Scene const& scene);

/// As above, and where the scene has an environment map also F_sky.exr and F.yaml, which joins the two.
/// @return the files, in the order they were written
std::vector<std::filesystem::path> write_scene_bundle(std::filesystem::path const& glb, Scene const& scene,
                                                      Report& report);

} // namespace gi
