#include "ar/pipeline/pose_finder.h"

#include "ar/capture/clock.h"
#include "ar/pipeline/pose_use.h"

namespace ar {

PoseFinder::PoseFinder(PoseUse const& use, MarkerMap const& markers, CameraModel const& camera)
    : use_(use), camera_(camera), detector_(markers), tracker_(tracker_settings(use)), trust_(use.trust)
{
    if (!use.features.empty()) features_.emplace(read_feature_map(use.features), camera);
    if (use.fused) fusion_.emplace();
}

std::string cause_of_loss(Sighting const& s, PoseEstimate const& pose)
{
    if (!s.contradictions.empty()) return "board contradicts the map";
    if (s.markers_ambiguous > 0) return "marker identifiers seen twice";
    if (s.markers_seen == 0)
        return s.markers_unknown > 0 ? "only markers that the map does not have" : "no markers";
    return name_of(pose.failure);
}

FoundPose PoseFinder::next(double time_s, cv::Mat const& gray, gi::StopRequest const* stop)
{
    FoundPose f;
    if (features_) {
        f.pose = features_->next(time_s, gray, tracker_.expected(time_s), f.sighting, stop);
        f.detected_s = steady_now_s();
    } else {
        f.sighting = detector_.next(gray);
        f.detected_s = steady_now_s();
        f.pose = estimate_pose(f.sighting, camera_, tracker_.expected(time_s));
    }
    if (fusion_) f.pose = fusion_->next(time_s, f.pose);
    Taken const taken = tracker_.add(time_s, f.pose);
    f.used = trust_.next(time_s, offered_pose(use_, tracker_, time_s, f.pose, taken));
    if (f.used.state == PoseState::tracked) return f;
    if (f.pose.found())
        f.lost_by = taken == Taken::jump ? "a jump" : "low confidence";
    else
        f.lost_by = features_ ? "features: " + name_of(f.pose.failure) : cause_of_loss(f.sighting, f.pose);
    return f;
}

FoundPose PoseFinder::next(double time_s, std::optional<gi::RigidPose> const& known)
{
    FoundPose f;
    if (known) {
        f.pose.failure = PoseFailure::none;
        f.pose.world_from_camera = *known;
        f.pose.confidence = 1;
    }
    f.used = trust_.next(time_s, {known, {}, f.pose.found()});
    if (!known) f.lost_by = "none by the tracker or file";
    return f;
}

} // namespace ar
