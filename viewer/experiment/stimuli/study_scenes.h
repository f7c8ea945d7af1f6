#pragma once
// How scenes of experiments are loaded.

#include "viewer/experiment/stimuli/stimulus_source.h"

namespace viewer {

/// Loads scenes as all commands do.
SceneAccess study_scenes();

} // namespace viewer
