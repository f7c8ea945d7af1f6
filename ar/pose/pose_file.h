#pragma once
// Poses from a file: of a tracked camera, of another program, of the viewer's recordings.
//   CSV  first line time_s,x_m,y_m,z_m,qx,qy,qz,qw; the same columns in every line
//   TUM  time x y z qx qy qz qw, by blanks, no header (the format of the TUM RGB-D benchmark, Sturm et al. 2012)
// Which it is, the first line that is neither empty nor begins with # says: CSV has commas. Times rise.

#include "ar/camera/pose.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ar {

struct TimedPose {
    double time_s = 0;
    Pose world_from_camera;
};

/// Which way a camera's axes lie in a file.
enum class CameraAxes {
    vision,  ///< x right, y down, z ahead: as in this program
    graphics ///< x right, y up, z back: OpenGL, glTF, headsets
};

/// @param file for messages
/// @throws gi::InputError with file:line:column: columns missing, not a number, not finite, not a quaternion of
/// length 1 (within 5 %), times that do not rise, no poses
std::vector<TimedPose> parse_poses(std::string_view text, std::string const& file,
                                   CameraAxes axes = CameraAxes::vision);
/// @throws gi::InputError, also for files above 1 GiB or that cannot be read
std::vector<TimedPose> read_poses(std::filesystem::path const& file, CameraAxes axes = CameraAxes::vision);
/// CSV, every number in all its digits.
std::string format_poses(std::vector<TimedPose> const& poses);

/// Between the two poses next to the time: straight, and the shorter turn at constant speed. Nothing before the
/// first, after the last, or in a gap longer than `longest_gap_s`.
std::optional<Pose> pose_at(std::vector<TimedPose> const& poses, double time_s, double longest_gap_s = 0.5);

} // namespace ar
