#pragma once
// Where a camera is by a tracker of a room, in place of markers: keys `pose` of a session.
//
//   world from camera = (world from room) (room from sensor) (sensor from camera)
//
// The tracker tells of the sensor, a body that is fixed to the camera. A sensor's axes are those of heads: x
// right, y up, z back; the camera's are x right, y down, z ahead.

#include "ar/camera/frame.h"
#include "ar/pose/pose_file.h"
#include "gi/core/report.h"
#include "gi/core/yaml.h"

#include <memory>

namespace viewer {

struct ArTracked {
    std::filesystem::path display; ///< its trackers; empty = the command line says it
    std::string tracker;           ///< by name; empty = that of the display's first user with one
    ar::Pose camera_from_sensor{glm::dquat(0, 1, 0, 0), glm::dvec3(0)}; ///< as heads look
    ar::Pose world_from_room;                                           ///< the world of the markers
    double offset_s = 0; ///< of recorded poses: their time at the first frame, since their first
};

/// @throws gi::InputError with file:line:column
ArTracked read_tracked(gi::Yaml const& pose, std::filesystem::path const& folder);

/// What its tracker has recorded, by seconds since the first frame.
/// @throws gi::InputError the tracker is live; as TrackedCamera
std::vector<ar::TimedPose> recorded_poses(ArTracked const& tracked, gi::Report& report);
/// @param poses   not empty. @param time_s  since the first frame; clocks of files round
/// @return nothing before the first and after the last
std::optional<ar::Pose> recorded_pose(std::vector<ar::TimedPose> const& poses, double time_s);
/// Its display and the meshes and the recording that this names. @throws gi::InputError as TrackedCamera
std::vector<std::filesystem::path> files_read_by(ArTracked const& tracked);

class TrackerHub;

class TrackedCamera {
public:
    /// Reads the display, begins to listen. @throws gi::InputError no such tracker, or one of a type that has no
    /// camera
    TrackedCamera(ArTracked const& tracked, gi::Report& report);
    /// By a hub that somebody else has made; its head is the sensor.
    TrackedCamera(ArTracked const& tracked, std::unique_ptr<TrackerHub> hub);
    ~TrackedCamera();

    /// Of a recorded file, by seconds since the first frame: nothing depends on clocks.
    std::vector<ar::TimedPose> const& recorded() const { return recorded_; }
    bool is_live() const { return hub_ != nullptr; }
    /// Between the samples next to that moment, or predicted from the last ones; nothing where the tracker has
    /// lost it, or is late by more than it predicts. @param steady_s  of the exposure, std::chrono::steady_clock
    std::optional<ar::Pose> at(double steady_s);
    /// Packets, losses, latency: lines of text; empty for recorded ones.
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
