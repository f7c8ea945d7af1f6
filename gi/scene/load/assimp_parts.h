#pragma once
// Parts of the conversion of a scene of Assimp: its small types, its materials, its clips.

#include "gi/core/math.h"
#include "gi/core/report.h"
#include "gi/scene/model/scene.h"

#include <assimp/scene.h>
#include <filesystem>
#include <map>
#include <string>

namespace gi {

/// Keys of maps that Assimp's own importers have not, or not for all formats: how strong normals are (glTF's
/// scale), and the channel of an opacity map ('r', 'g', 'b', 'm' = alpha, 'l' = luminance; 0 = not stated).
inline constexpr char const *kTextureStrength = "$tex.scale", *kTextureChannel = "$tex.lightwell.channel";

/// Our node indices by the names by which Assimp refers to them; of equal names, the first node.
using NodeOfName = std::map<std::string, std::int32_t>;

inline vec3 to_vec3(aiVector3D v) { return {v.x, v.y, v.z}; }
inline vec3 to_vec3(aiColor3D v) { return {v.r, v.g, v.b}; }
/// Negative and non-finite values become 0.
inline vec3 positive(vec3 v) { return all_finite(v) ? glm::max(v, vec3{0}) : vec3{0}; }

/// Converts materials with their textures, which are embedded or files in `folder` beside the scene.
void convert_materials(aiScene const& source, std::filesystem::path const& folder, Scene& scene, Report& report);

/// Converts clips with their channels. The matrices of moving nodes are split
/// into translation, rotation and scale.
void convert_animations(aiScene const& source, NodeOfName const& node_of, Scene& scene, Report& report);

} // namespace gi
