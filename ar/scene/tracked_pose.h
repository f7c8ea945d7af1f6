#pragma once
// Camera pose from a room's tracker instead of markers: key `pose` of a session.
//
//   world from camera = (world from room) (room from sensor) (sensor from camera)
//
// The tracker reports the pose of the sensor, a body fixed to the camera. A sensor's axes are those of heads: x
// right, y up, z back; the camera's are x right, y down, z ahead.

#include "ar/camera/frame.h"
#include "ar/pose/pose_file.h"
#include "gi/core/report.h"
#include "gi/core/yaml.h"

#include <memory>

namespace viewer {

struct ArTracked {
    std::filesystem::path display; ///< display file with the trackers; empty = set on the command line
    std::string tracker;           ///< name; empty = the tracker of the display's first user with one
    ar::Pose camera_from_sensor{glm::dquat(0, 1, 0, 0), glm::dvec3(0)}; ///< default: same viewing direction
    ar::Pose world_from_room;                                           ///< the world of the markers
    double offset_s = 0; ///< for recorded poses: time of the first frame, since the first pose
};

/// @throws gi::InputError with file:line:column
ArTracked read_tracked(gi::Yaml const& pose, std::filesystem::path const& folder);

/// The tracker's recorded poses, by seconds since the first frame.
/// @throws gi::InputError if the tracker is live, and as TrackedCamera
std::vector<ar::TimedPose> recorded_poses(ArTracked const& tracked, gi::Report& report);
/// @param poses   not empty. @param time_s  since the first frame; may be rounded, as file clocks are
/// @return nothing before the first and after the last
std::optional<ar::Pose> recorded_pose(std::vector<ar::TimedPose> const& poses, double time_s);
/// The display file, and the meshes and recording it references. @throws gi::InputError as TrackedCamera
std::vector<std::filesystem::path> files_read_by(ArTracked const& tracked);

class TrackerHub;

class TrackedCamera {
public:
    /// Reads the display and starts to listen.  @throws gi::InputError no such tracker,
    /// or a tracker type without a camera
    TrackedCamera(ArTracked const& tracked, gi::Report& report);
    /// Uses an existing hub, whose head is the sensor.
    TrackedCamera(ArTracked const& tracked, std::unique_ptr<TrackerHub> hub);
    ~TrackedCamera();

    /// Poses of a recorded file, by seconds since the first frame, independent of clocks.
    std::vector<ar::TimedPose> const& recorded() const { return recorded_; }
    bool is_live() const { return hub_ != nullptr; }
    /// Pose interpolated between the nearest samples, or predicted from the last ones;
    /// nothing if the tracker has lost it, or the time is beyond the prediction limit.
    /// @param steady_s  of the exposure, std::chrono::steady_clock
    std::optional<ar::Pose> at(double steady_s);
    /// Lines of text with packets, losses and latency; empty for recorded poses.
    std::string describe() const;

private:
    ar::Pose world_from_camera(ar::Pose const& room_from_sensor) const;

    ArTracked tracked_;
    ar::Pose sensor_from_camera_;
    std::vector<ar::TimedPose> recorded_;
    std::unique_ptr<TrackerHub> hub_;
    std::uint64_t asked_ = 0, known_ = 0;
};

} // namespace viewer
