#pragma once
// What identifies a scene's content for the records of sessions.

#include "gi/scene/model/scene.h"

#include <string>

namespace viewer {

/// SHA-256 of the contents of all files of the scene, whatever their folder; empty for generated scenes, which the
/// program's version identifies. @throws InputError a file cannot be read
std::string scene_sha256(gi::Scene const& scene);

} // namespace viewer
