#pragma once
// What is known about a frame's pose: its own estimate, if it can be trusted,
// or the tracker's filtered or predicted pose.

#include "ar/pose/tracker.h"
#include "ar/pose/trust.h"
#include "ar/scene/session_file.h"

namespace ar {

/// The tracker's settings, with the session's least confidence.
PoseTrackerSettings tracker_settings(PoseUse const& use);

/// @param track  must already have the estimate  @param taken  its answer
OfferedPose offered_pose(PoseUse const& use, PoseTracker const& track, double time_s, PoseEstimate const& estimate,
                         Taken taken);

} // namespace ar
