#pragma once
// The camera's pose from a room's tracker, live or recorded, as ar::TrackerUse says.

#include "ar/pose/pose_file.h"
#include "ar/scene/session_file.h"
#include "gi/core/report.h"

#include <memory>

namespace viewer {

/// The tracker's recorded poses, by seconds since the first frame.
/// @throws gi::InputError if the tracker is live, and as CameraTracker
std::vector<ar::TimedPose> recorded_poses(ar::TrackerUse const& use, gi::Report& report);
/// The display file, and the meshes and recording it references. @throws gi::InputError as CameraTracker
std::vector<std::filesystem::path> files_read_by(ar::TrackerUse const& use);

class TrackerHub;

class CameraTracker {
public:
    /// Reads the display and starts to listen.  @throws gi::InputError no such tracker,
    /// or a tracker type without a camera
    CameraTracker(ar::TrackerUse const& use, gi::Report& report);
    /// Uses an existing hub, whose head is the sensor.
    CameraTracker(ar::TrackerUse const& use, std::unique_ptr<TrackerHub> hub);
    ~CameraTracker();

    /// Poses of a recorded file, by seconds since the first frame, independent of clocks.
    std::vector<ar::TimedPose> const& recorded() const { return recorded_; }
    bool is_live() const { return hub_ != nullptr; }
    /// Pose interpolated between the nearest samples, or predicted from the last ones;
    /// nothing if the tracker has lost it, or the time is beyond the prediction limit.
    /// @param steady_s  of the exposure, std::chrono::steady_clock
    std::optional<gi::RigidPose> at(double steady_s);
    /// Lines of text with packets, losses and latency; empty for recorded poses.
    std::string describe() const;

private:
    gi::RigidPose world_from_camera(gi::RigidPose const& room_from_sensor) const;

    ar::TrackerUse use_;
    gi::RigidPose sensor_from_camera_;
    std::vector<ar::TimedPose> recorded_;
    std::unique_ptr<TrackerHub> hub_;
    std::uint64_t asked_ = 0, known_ = 0;
};

} // namespace viewer
