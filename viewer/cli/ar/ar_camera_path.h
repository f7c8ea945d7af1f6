#pragma once
// The camera's poses in a session's frames, for commands that only need poses: frame by frame, in order.

#include "ar/markers/marker_map_file.h"
#include "ar/pipeline/pose_losses.h"
#include "ar/runtime/runner.h"
#include "viewer/camera_view/camera_tracker.h"
#include "viewer/cli/ar/pose_arguments.h"

namespace viewer {

/// Camera poses from the --poses file, from a recorded tracker, or found in the frames as `ar run` finds them.
class CameraPath {
public:
    CameraPath(PoseArguments const& poses, ar::Session const& session, ar::CalibratedCamera const& camera,
               gi::Report& report)
        : finder_(session.pose, ar::read_marker_map(session.markers, &report), camera.model), report_(report)
    {
        check_rotation_order(poses.order, {poses.file});
        if (!poses.file.empty())
            poses_ = poses_of(poses, session, report);
        else if (session.tracked)
            poses_ = recorded_poses(*session.tracked, report);
    }
    /// Pose and its confidence; nothing if this frame has none that is trusted.
    std::optional<std::pair<gi::RigidPose, double>> at(ar::Frame const& frame, double time_s,
                                                       gi::StopRequest const& stop)
    {
        if (!poses_.empty()) {
            auto const pose = ar::recorded_pose(poses_, time_s);
            if (!pose) return std::nullopt;
            return std::pair(*pose, 1.0);
        }
        ar::FoundPose const f = finder_.next(time_s, ar::gray_of(frame), &stop);
        losses_.add(f, frame.sequence, report_);
        if (f.used.state != ar::PoseState::tracked || f.pose.ambiguous) return std::nullopt;
        return std::pair(*f.used.world_from_camera, f.pose.confidence);
    }

private:
    std::vector<ar::TimedPose> poses_;
    ar::PoseFinder finder_;
    ar::PoseLosses losses_;
    gi::Report& report_;
};

} // namespace viewer
