#pragma once
// Reads poses from a file: of a tracked camera, another program, or the viewer's recordings.
//   CSV  first line time_s,x_m,y_m,z_m,qx,qy,qz,qw; the same columns in every line
//   TUM  time x y z qx qy qz qw, separated by blanks, no header (TUM RGB-D benchmark,
// Sturm et al. 2012) The format is detected from the first line that is neither empty nor begins with
// #: CSV has commas. Times must increase.

#include "ar/camera/pose.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ar {

struct TimedPose {
    double time_s = 0;
    gi::RigidPose world_from_camera;
};

/// Convention of the camera's axes in a file.
enum class CameraAxes {
    vision,  ///< x right, y down, z ahead: as in this program
    graphics ///< x right, y up, z back: OpenGL, glTF, headsets
};

/// @param file name of the file for messages
/// @throws gi::InputError with file:line:column: missing columns, not a number, not finite, not a quaternion of
/// length 1 (within 5 %), times that do not increase, no poses
std::vector<TimedPose> parse_poses(std::string_view text, std::string const& file,
                                   CameraAxes axes = CameraAxes::vision);

/// The order in which an object is turned about the axes of its parent, first to last: of ZXY about z, then x, then
/// y, R = Ry Rx Rz. Nuke's files (.chan) do not say which.
enum class RotationOrder { xyz, xzy, yxz, yzx, zxy, zyx };
std::vector<std::string> const& rotation_order_names(); ///< "XYZ", ..., in the order above
std::string name_of(RotationOrder order);
std::optional<RotationOrder> rotation_order_named(std::string const& name);

/// What files of poses do not say.
struct FrameNumbering {
    double frames_per_s = 0;          ///< > 0; Blender's file has its own
    std::optional<double> first = {}; ///< number of the frame at time 0; nothing = that of the first pose
    /// Of Nuke's angles; nothing = ZXY, the default of Nuke's cameras.
    std::optional<RotationOrder> order = {};
};
struct PoseFile {
    std::vector<TimedPose> poses;
    std::optional<double> first_frame;       ///< number of the frame at time 0; nothing: the file has times
    std::optional<RotationOrder> order = {}; ///< that was taken; nothing: the file has no angles
};
/// Reads a file of a format above or in ar/pose/pose_import.h.
/// @param axes  of CSV and TUM
/// @throws gi::InputError as the parsers, for files above 1 GiB, those that cannot be read, for `numbering.first`
/// with a file of times, and for `numbering.order` with a file that is not Nuke's
PoseFile read_poses(std::filesystem::path const& file, FrameNumbering const& numbering,
                    CameraAxes axes = CameraAxes::vision);
/// Formats as CSV with full precision.
std::string format_poses(std::vector<TimedPose> const& poses);

/// Interpolates between the two nearest poses: position linearly, rotation by slerp along the shorter arc. Nothing
/// before the first, after the last, or in a gap longer than `longest_gap_s`.
std::optional<gi::RigidPose> pose_at(std::vector<TimedPose> const& poses, double time_s,
                                     double longest_gap_s = 0.5);
/// As pose_at, for times that may be rounded, as file clocks are. @param poses  not empty
std::optional<gi::RigidPose> recorded_pose(std::vector<TimedPose> const& poses, double time_s);

} // namespace ar
