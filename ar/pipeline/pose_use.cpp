#include "ar/pipeline/pose_use.h"

namespace viewer {

bool use_pose(ArPoseUse const& use, ar::PoseTracker const& track, double time_s, ar::PoseEstimate& pose)
{
    bool const found = pose.found();
    if (!(found ? use.filtered : use.predict_s > 0)) return false;
    ar::TrackedPose const tracked = track.at(time_s);
    // An estimate refused as a jump is replaced, too: the newest accepted one is older.
    double const oldest_s = found ? use.tracker.predict_s : use.predict_s;
    bool const stands = use.tracker.motion == ar::CameraMotion::tripod && found;
    if (!tracked.world_from_camera || (!stands && tracked.age_s > oldest_s)) return false;
    if (!found) {
        pose.failure = ar::PoseFailure::none;
        pose.confidence = tracked.confidence;
    }
    pose.world_from_camera = *tracked.world_from_camera;
    return !found;
}

} // namespace viewer
