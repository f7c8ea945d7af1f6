#pragma once
// A later moment of a frame's scene, for which its picture is shown.

#include "gi/scene/motion/animation.h"
#include "viewer/engine/live/live_renderer.h"

namespace viewer {

/// Time of the scene's clips at a moment of the session's clock, s.
double scene_time_at(LiveFrame const& frame, double now_s);
/// The frame's command with all views, the users and cameras of a viewpoint (those of the command, if it has other
/// views), the scene time of a moment, and the edits that are newer than the frame.
FrameCommand moment_at(LiveFrame const& frame, Viewpoint const& at, double now_s, std::vector<Change> edits);
/// Pause after drawing a picture, s: a software driver leaves time to the light of edited lamps, as much as it draws, and
/// to that of edited objects, as long as they move 18 times a second. @param drawing_s  that a picture takes
double drawing_pause_s(std::vector<Change> const& edits, bool in_software, double drawing_s);
/// Whether surfaces drawn with the light of a frame would be the same at two moments.
bool look_same(LiveFrame const& frame, FrameCommand const& a, FrameCommand const& b);
/// Where the objects of a frame's scene are at a moment. Edits that cannot be made change nothing.
gi::Pose pose_at(SessionFrame const& frame, FrameCommand const& moment, DriveBodies const& drive);
/// Its punctual lights then; empty, as ShownScene::lights.
std::vector<gi::Light> lights_at(SessionFrame const& frame, FrameCommand const& moment);

} // namespace viewer
