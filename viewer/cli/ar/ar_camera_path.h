#pragma once
// The camera's poses in a session's frames, for commands that only need poses: frame by frame, in order.

#include "ar/markers/marker_map_file.h"
#include "ar/runtime/runner.h"
#include "viewer/cli/ar/pose_arguments.h"

namespace viewer {

/// Camera poses from the --poses file, from a recorded tracker, or from the markers in the frame.
class CameraPath {
public:
    CameraPath(PoseArguments const& poses, ArSession const& session, ArCamera const& camera, gi::Report& report)
        : camera_(camera),
          least_(session.pose.trust.least_confidence),
          detector_(ar::read_marker_map(session.markers))
    {
        if (!poses.file.empty())
            poses_ = poses_of(poses, session, report);
        else if (session.tracked)
            poses_ = recorded_poses(*session.tracked, report);
    }
    /// Pose and its confidence; nothing if it is not trusted (pose.least_confidence, ambiguous).
    std::optional<std::pair<ar::Pose, double>> at(ar::Frame const& frame, double time_s)
    {
        if (!poses_.empty()) {
            auto const pose = recorded_pose(poses_, time_s);
            if (!pose) return std::nullopt;
            return std::pair(*pose, 1.0);
        }
        ar::PoseEstimate const p =
            ar::estimate_pose(detector_.next(ar::gray_of(frame)), camera_.model, tracker_.expected(time_s));
        tracker_.add(time_s, p);
        if (!p.found() || p.ambiguous || p.confidence < least_) return std::nullopt;
        return std::pair(p.world_from_camera, p.confidence);
    }

private:
    ArCamera const& camera_;
    double least_;
    std::vector<ar::TimedPose> poses_;
    ar::MarkerTracker detector_;
    ar::PoseTracker tracker_;
};

} // namespace viewer
