#include "ar/pipeline/pose_use.h"

namespace ar {

PoseTrackerSettings tracker_settings(PoseUse const& use)
{
    PoseTrackerSettings settings = use.tracker;
    settings.least_confidence = use.trust.least_confidence;
    return settings;
}

OfferedPose offered_pose(PoseUse const& use, PoseTracker const& track, double time_s, PoseEstimate const& estimate,
                         Taken taken)
{
    OfferedPose offered;
    offered.is_estimated = estimate.found();
    // If an ambiguous estimate jumps, its other pose may be the true one.
    bool const is_doubtful = taken == Taken::jump && estimate.ambiguous;
    bool const is_confident = estimate.found() && estimate.confidence >= use.trust.least_confidence;
    FilteredPose const tracked = track.at(time_s);
    if (use.filtered && tracked.world_from_camera) {
        // An estimate refused as a jump is replaced, too: the newest accepted one is older.
        bool const stands = use.tracker.motion == CameraMotion::tripod && estimate.found();
        if (stands || (is_confident && tracked.age_s <= use.tracker.predict_s))
            offered.trusted = tracked.world_from_camera;
    } else if (is_confident && !is_doubtful) {
        offered.trusted = estimate.world_from_camera;
    }
    if (use.predict_s > 0 && tracked.world_from_camera && tracked.age_s <= use.predict_s)
        offered.predicted = tracked.world_from_camera;
    return offered;
}

} // namespace ar
