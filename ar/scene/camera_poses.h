#pragma once
// Camera poses for a session's frames, from a file of poses (ar/pose/pose_file.h) or from the animated camera of a
// scene file, as matchmoving programs and modellers export it: glTF, FBX, COLLADA.

#include "ar/pose/pose_file.h"
#include "gi/core/report.h"

namespace viewer {

/// @param frames_per_s  of frames that a file numbers instead of giving times, and of the samples of an animated
///   camera; its first key is the first frame
/// @throws gi::InputError as of read_poses; a scene file with no camera or several
std::vector<ar::TimedPose> read_camera_poses(std::filesystem::path const& file, double frames_per_s,
                                             gi::Report& report);

} // namespace viewer
