#pragma once
// The camera's pose frame by frame, as a session says: from markers or a map of features, fused, filtered, and
// used only if it is trusted.

#include "ar/features/feature_tracker.h"
#include "ar/markers/detect.h"
#include "ar/pose/fused.h"
#include "ar/pose/tracker.h"
#include "ar/pose/trust.h"
#include "ar/scene/session_file.h"

namespace viewer {

/// A camera pose that is not estimated from the frame, but comes from a tracker or a file;
/// nothing: that has none for this frame.
struct KnownPose {
    explicit KnownPose(std::optional<ar::Pose> const& world_from_camera_) : world_from_camera(world_from_camera_)
    {
    }
    KnownPose(ar::Pose const& world_from_camera_) : world_from_camera(world_from_camera_) {}
    std::optional<ar::Pose> world_from_camera;
};

struct FoundPose {
    ar::Sighting sighting;
    ar::PoseEstimate pose; ///< the frame's own estimate, or the known pose
    ar::UsedPose used;
    std::optional<double> detected_s; ///< steady clock, end of detection; nothing with a known pose
};

class PoseFinder {
public:
    /// @throws gi::InputError a map of features that cannot be read
    PoseFinder(ArPoseUse const& use, ar::MarkerMap const& markers, ar::CameraModel const& camera);

    /// Call for every frame, in order.
    /// @param time_s  since the first frame  @param gray  CV_8UC1 of the camera's size
    /// @param stop  null = none; a pose may be missing after a request
    FoundPose next(double time_s, cv::Mat const& gray, gi::StopRequest const* stop = nullptr);
    /// Without looking at the frame.
    FoundPose next(double time_s, KnownPose const& known);

    ar::TrackerCounts const& tracker() const { return tracker_.counts(); }
    std::array<std::uint64_t, ar::kPoseStates> const& states() const { return trust_.counts(); }
    /// Null without a map of features.
    ar::FeatureTrackerCounts const* features() const { return features_ ? &features_->counts() : nullptr; }

private:
    ArPoseUse use_;
    ar::CameraModel camera_;
    ar::MarkerTracker detector_;
    std::optional<ar::FeatureTracker> features_; ///< instead of the detector
    std::optional<ar::PoseFusion> fusion_;
    ar::PoseTracker tracker_;
    ar::PoseTrust trust_;
};

} // namespace viewer
