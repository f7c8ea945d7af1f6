#pragma once
// Finds the camera by a map of features. Features are followed from picture to picture by optical flow, and looked
// for again every few pictures where the pose predicts them, which ends their drift. After a loss they are
// recognised by their descriptors alone.

#include "ar/features/feature_map.h"
#include "ar/features/flow.h"
#include "ar/pose/estimate.h"
#include "gi/core/progress.h"

namespace ar {

struct FeatureTrackerSettings {
    int look_every = 5;         ///< pictures between searches for the map's features
    std::size_t followed = 200; ///< at most
    std::size_t fewest = 12;    ///< features of a pose; with fewer, the map is searched again
    double near_px = 8;         ///< where a predicted feature is looked for
    int alike_bits = 64;        ///< descriptors farther apart are of other features
    double trusted_flow_s = 2;  ///< confidence falls to exp(-1) if nothing was recognised for this long
};

struct FeatureTrackerCounts {
    std::uint64_t pictures = 0, relocated = 0, not_relocated = 0, looked = 0;
};

class FeatureTracker {
public:
    /// @throws gi::InputError as check_size(map)
    FeatureTracker(FeatureMap map, CameraModel const& camera, FeatureTrackerSettings const& settings = {});

    /// The pose in the next picture; its confidence falls with the time since features were last recognised.
    /// @param gray  CV_8UC1 of the camera's size  @param expected  pose, if it can be predicted
    /// @param[out] seen  the map's points in the picture
    /// @param stop  null = none; after a request, the map is not searched again
    PoseEstimate next(double time_s, cv::Mat const& gray, std::optional<gi::RigidPose> const& expected,
                      Sighting& seen, gi::StopRequest const* stop = nullptr);
    /// Time since features were last recognised in the map instead of tracked from the previous frame (s).
    double flow_s() const { return flow_s_; }
    FeatureTrackerCounts const& counts() const { return counts_; }

private:
    struct Followed {
        int point;
        glm::dvec2 pixel;
        double sigma_px; ///< of the recognised feature; grows as it is followed
    };

    void follow(cv::Mat const& gray, std::optional<gi::RigidPose> const& expected);
    /// Number of features that were recognised.
    std::size_t look(PictureFeatures const& features, gi::RigidPose const& world_from_camera);
    bool relocate(PictureFeatures const& features, gi::StopRequest const* stop);
    Sighting sighting() const;
    PoseEstimate estimate(std::optional<gi::RigidPose> const& expected, Sighting& seen);

    FeatureMap map_;
    CameraModel camera_;
    FeatureTrackerSettings settings_;
    cv::Mat descriptors_;       ///< of all points, one a row
    std::vector<int> point_of_; ///< of each row
    Flow flow_;
    std::vector<Followed> followed_;
    std::optional<gi::RigidPose> last_; ///< of the picture before
    double recognised_s_ = 0, flow_s_ = 0;
    int since_look_ = 0;
    FeatureTrackerCounts counts_;
};

} // namespace ar
