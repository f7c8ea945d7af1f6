#pragma once
// The content of scenes as sessions record it: by names alone, a file that was replaced between two participants would
// look the same.

#include "study/journal/entries.h"

#include <span>
#include <string>
#include <vector>

namespace study {

/// The fact of SessionStarted::about with the SHA-256 of a scene's files.
std::string scene_fact(std::string const& scene);
/// Scenes that had another content in some parts of sessions than in the first that has them: one sentence each.
std::vector<std::string> changed_scenes(std::span<SessionStarted const* const> parts);

} // namespace study
