#pragma once
// Conversion of Assimp's small types to ours.

#include "gi/core/math.h"

#include <assimp/scene.h>
#include <map>
#include <string>

namespace gi {

/// Our node indices by the names by which Assimp refers to them; of equal names, the first node.
using NodeOfName = std::map<std::string, std::int32_t>;

inline vec3 to_vec3(aiVector3D v) { return {v.x, v.y, v.z}; }
inline vec3 to_vec3(aiColor3D v) { return {v.r, v.g, v.b}; }
/// Negative and non-finite values become 0.
inline vec3 positive(vec3 v) { return all_finite(v) ? glm::max(v, vec3{0}) : vec3{0}; }

} // namespace gi
