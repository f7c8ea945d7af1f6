#pragma once
// Which pose a frame is shown with: its estimate, or what the track makes of it.

#include "ar/pose/tracker.h"
#include "ar/scene/session_file.h"

namespace viewer {

/// @param track  has been given the estimate  @param pose  the estimate; becomes the pose to show
/// @return whether the frame had no pose and is shown with a predicted one
bool use_pose(ArPoseUse const& use, ar::PoseTracker const& track, double time_s, ar::PoseEstimate& pose);

} // namespace viewer
