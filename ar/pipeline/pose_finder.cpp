#include "ar/pipeline/pose_finder.h"

#include "ar/capture/clock.h"
#include "ar/pipeline/pose_use.h"

namespace viewer {

PoseFinder::PoseFinder(ArPoseUse const& use, ar::MarkerMap const& markers, ar::CameraModel const& camera)
    : use_(use), camera_(camera), detector_(markers), tracker_(tracker_settings(use)), trust_(use.trust)
{
    if (!use.features.empty()) features_.emplace(ar::read_feature_map(use.features), camera);
    if (use.fused) fusion_.emplace();
}

FoundPose PoseFinder::next(double time_s, cv::Mat const& gray, gi::StopRequest const* stop)
{
    FoundPose f;
    if (features_) {
        f.pose = features_->next(time_s, gray, tracker_.expected(time_s), f.sighting, stop);
        f.detected_s = ar::steady_now_s();
    } else {
        f.sighting = detector_.next(gray);
        f.detected_s = ar::steady_now_s();
        f.pose = ar::estimate_pose(f.sighting, camera_, tracker_.expected(time_s));
    }
    if (fusion_) f.pose = fusion_->next(time_s, f.pose);
    ar::Taken const taken = tracker_.add(time_s, f.pose);
    f.used = trust_.next(time_s, offered_pose(use_, tracker_, time_s, f.pose, taken));
    return f;
}

FoundPose PoseFinder::next(double time_s, KnownPose const& known)
{
    FoundPose f;
    if (known.world_from_camera) {
        f.pose.failure = ar::PoseFailure::none;
        f.pose.world_from_camera = *known.world_from_camera;
        f.pose.confidence = 1;
    }
    f.used = trust_.next(time_s, {known.world_from_camera, {}, f.pose.found()});
    return f;
}

} // namespace viewer
