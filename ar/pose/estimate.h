#pragma once
// Where the camera is, from one picture's sighting.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/camera/sighting.h"

#include <optional>
#include <string>
#include <vector>

namespace ar {

enum class PoseFailure {
    none,
    too_few_points, ///< fewer than 4 that are finite and at places that differ
    on_a_line,      ///< all points on one line
    no_agreement,   ///< no pose that at least 4 points, and half of all, agree with
    undetermined    ///< the points that agree leave a direction free
};
std::string name_of(PoseFailure failure);

struct PoseEstimate {
    PoseFailure failure = PoseFailure::too_few_points;
    /// What follows is meaningful if `failure` is none, but for the counts.
    Pose world_from_camera;
    double rms_px = 0; ///< root mean square of the reprojection errors of the points used
    int points_used = 0;
    int points_rejected = 0; ///< not finite, or not in agreement; used + rejected = all points
    std::vector<int> markers_used;
    std::vector<int> markers_rejected; ///< of which no point was used
    /// Of position in the world (m) and rotation about the camera's axes (rad): the inverse of the information of
    /// the points at their sigma_px, times the residuals' variance where that is above 1.
    cv::Matx66d covariance = cv::Matx66d::zeros();
    glm::dvec3 position_sigma_m{0};   ///< along the world's axes
    glm::dvec3 rotation_sigma_deg{0}; ///< about the camera's axes
    /// The second pose that a plane allows, where it is more than half a degree from the first.
    std::optional<Pose> other;
    double other_rms_px = 0;
    /// Of the other pose: exp(-d/2) / (1 + exp(-d/2)), d = the difference of both chi^2. 0 to 1, more than 0.5
    /// only if `last` decided for the pose that explains the picture less well.
    double other_likelihood = 0;
    bool ambiguous = false; ///< other_likelihood > 0.01
    /// 0..1: share of points used, times min(1, 2 / residuals in sigmas), times (1 - other_likelihood; at least
    /// 0.5 where `last` decided), over 1 + (largest standard deviation of the rotation in degrees)^2.
    double confidence = 0;

    bool found() const { return failure == PoseFailure::none; }
};

/// First guesses of all points and of single markers (IPPE, SQPnP), judged by how many points agree; then
/// refined robustly, whole markers and single points that disagree (by 5 sigmas, more where all points are worse
/// than their sigmas say, at most 25) are left out, and the rest is refined by least squares.
/// @param last where the camera was lately: decides between two poses where the picture does not (`ambiguous`),
/// and
///             is a further first guess
PoseEstimate estimate_pose(Sighting const& sighting, CameraModel const& camera,
                           std::optional<Pose> const& last = std::nullopt);

} // namespace ar
