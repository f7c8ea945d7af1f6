#pragma once
// Selects the pose for a frame: its own estimate, or the tracker's filtered or predicted one.

#include "ar/pose/tracker.h"
#include "ar/scene/session_file.h"

namespace viewer {

/// @param track  must already have the estimate  @param pose  in: the estimate; out: the pose to use
/// @return true if the frame had no pose and gets a predicted one
bool use_pose(ArPoseUse const& use, ar::PoseTracker const& track, double time_s, ar::PoseEstimate& pose);

} // namespace viewer
