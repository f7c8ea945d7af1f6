#pragma once
// Camera poses for a session's frames, from a file of poses (ar/pose/pose_file.h) or from the animated camera of a
// scene file, as matchmoving programs and modellers export it: glTF, FBX, COLLADA.

#include "ar/pose/pose_file.h"
#include "ar/scene/session_file.h"
#include "gi/core/report.h"

namespace ar {

/// @param numbering  of frames that a file numbers instead of giving times; its rate is also that of the samples
///   of an animated camera, whose first key is the first frame
/// @throws gi::InputError as of read_poses; a scene file with no camera or several, or with `numbering.first`
PoseFile read_camera_poses(std::filesystem::path const& file, FrameNumbering const& numbering, gi::Report& report);

/// Rate of a session's frames: a video's or recording's own, else its key rate_hz. Opens files, but no devices.
/// @throws gi::InputError as of open_source
double frames_per_s_of(SessionFrames const& frames);

} // namespace ar
