#pragma once
// A later moment of a frame's scene, for which its picture is shown.

#include "gi/scene/motion/animation.h"
#include "viewer/engine/live/live_renderer.h"

namespace viewer {

/// Time of the scene's clips at a moment of the session's clock, s.
double scene_time_at(LiveFrame const& frame, double now_s);
/// The frame's command with the users and cameras of a viewpoint (those of the command, if it has other views), and the
/// scene time of a moment.
FrameCommand moment_at(LiveFrame const& frame, Viewpoint const& at, double now_s);
/// Where the objects of a frame's scene are at a moment.
gi::Pose pose_at(SessionFrame const& frame, FrameCommand const& moment, DriveBodies const& drive);

} // namespace viewer
