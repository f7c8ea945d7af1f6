#pragma once
// What the pictures of a stimulus from an AR session depend on.

#include "viewer/experiment/stimuli/ar_stimulus.h"

namespace viewer {

/// Hash of all files of the session (frames, calibration, maps, scenes), of poses and of truth pictures.
std::string content_hash(ArStimulus const& stimulus);

} // namespace viewer
