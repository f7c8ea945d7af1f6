#pragma once
#include "gi/core/report.h"
#include "gi/scene/load/assimp_types.h"
#include "gi/scene/model/scene.h"

namespace gi {

/// Converts clips with their channels. The matrices of moving nodes are split
/// into translation, rotation and scale.
void convert_animations(aiScene const& source, NodeOfName const& node_of, Scene& scene, Report& report);

} // namespace gi
