#pragma once
// What is known about a frame's pose: its own estimate, if it can be trusted,
// or the tracker's filtered or predicted pose.

#include "ar/pose/tracker.h"
#include "ar/pose/trust.h"
#include "ar/scene/session_file.h"

namespace viewer {

/// The tracker's settings, with the session's least confidence.
ar::PoseTrackerSettings tracker_settings(ArPoseUse const& use);

/// @param track  must already have the estimate  @param taken  its answer
ar::OfferedPose offered_pose(ArPoseUse const& use, ar::PoseTracker const& track, double time_s,
                             ar::PoseEstimate const& estimate, ar::Taken taken);

} // namespace viewer
