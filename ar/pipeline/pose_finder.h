#pragma once
// The camera's pose frame by frame, as a session says: from markers or a map of features, fused, filtered, and
// used only if it is trusted.

#include "ar/features/feature_tracker.h"
#include "ar/markers/detect.h"
#include "ar/pose/fused.h"
#include "ar/pose/tracker.h"
#include "ar/pose/trust.h"
#include "ar/scene/session_file.h"

namespace ar {

struct FoundPose {
    Sighting sighting;
    PoseEstimate pose; ///< the frame's own estimate, or the known pose
    UsedPose used;
    std::optional<double> detected_s; ///< steady clock, end of detection; nothing with a known pose
    std::string lost_by;              ///< why the frame has no trusted pose of its own; empty if it has one
};

/// Why no pose was estimated: "board contradicts the map", "marker identifiers seen twice", "only markers that the map
/// does not have", "no markers", or of name_of(PoseFailure). @param pose  not found
std::string cause_of_loss(Sighting const& sighting, PoseEstimate const& pose);

class PoseFinder {
public:
    /// @throws gi::InputError a map of features that cannot be read
    PoseFinder(PoseUse const& use, MarkerMap const& markers, CameraModel const& camera);

    /// Call for every frame, in order.
    /// @param time_s  since the first frame  @param gray  CV_8UC1 of the camera's size
    /// @param stop  null = none; a pose may be missing after a request
    FoundPose next(double time_s, cv::Mat const& gray, gi::StopRequest const* stop = nullptr);
    /// Without looking at the frame. @param known  of a tracker or a file; nothing: that has none for this frame
    FoundPose next(double time_s, std::optional<gi::RigidPose> const& known);

    TrackerCounts const& tracker() const { return tracker_.counts(); }
    std::array<std::uint64_t, kPoseStates> const& states() const { return trust_.counts(); }
    /// Null without a map of features.
    FeatureTrackerCounts const* features() const { return features_ ? &features_->counts() : nullptr; }

private:
    PoseUse use_;
    CameraModel camera_;
    MarkerTracker detector_;
    std::optional<FeatureTracker> features_; ///< instead of the detector
    std::optional<PoseFusion> fusion_;
    PoseTracker tracker_;
    PoseTrust trust_;
};

} // namespace ar
