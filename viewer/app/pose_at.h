#pragma once
// Where the objects of a frame's scene are later than in the frame.

#include "gi/scene/motion/animation.h"
#include "viewer/engine/live/live_renderer.h"

namespace viewer {

/// Time of the scene's clips at a moment of the session's clock, s.
double scene_time_at(LiveFrame const& frame, double now_s);
/// @param at  where the users are then
gi::Pose pose_at(LiveFrame const& frame, Viewpoint const& at, DriveBodies const& drive, double now_s);

} // namespace viewer
