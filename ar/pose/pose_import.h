#pragma once
// Camera poses written by other programs. All are converted to metres, y up, and the camera's axes x right, y
// down, z ahead. They number their frames; which number has the time 0 is FrameNumbering's (ar/pose/pose_file.h).
//
// COLMAP (images.txt, Schoenberger and Frahm 2016): two lines an image,
//   IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME
//   X Y POINT3D_ID ...  (maybe an empty line)
// Camera from world; camera x right, y down, z ahead. Frames are numbered by the last number in NAME. World and
// scale are kept as they are in the file.
//
// Nuke (.chan): FRAME TX TY TZ RX RY RZ [VFOV]; degrees, in the camera's rotation order, which the file does not say:
// FrameNumbering::order, by default ZXY as of Nuke's cameras; world y up; camera looks along -z with y up.
//
// Blender (.json): {"lightwell_camera": 1, "fps": 24, "frames": [{"frame": 1, "position": [x, y, z],
// "rotation_wxyz": [w, x, y, z]}, ...]}, from world matrices of the camera; world z up; camera looks along -z with
// y up. docs/ar.md has the script that writes it.

#include "ar/pose/pose_file.h"

namespace ar {

enum class PoseFormat { csv_or_tum, colmap, nuke_chan, blender_json };
/// By the file's extension (.chan, .json) or content (ten or more words in the first line: COLMAP).
PoseFormat pose_format(std::string_view text, std::string const& file);

/// @throws gi::InputError with file:line:column; also if no pose is at or after the first frame
PoseFile parse_colmap_images(std::string_view text, std::string const& file, FrameNumbering const& numbering);
PoseFile parse_chan(std::string_view text, std::string const& file, FrameNumbering const& numbering);
/// @param numbering  its rate is not used
PoseFile parse_blender_json(std::string const& text, std::string const& file, FrameNumbering numbering);

} // namespace ar
