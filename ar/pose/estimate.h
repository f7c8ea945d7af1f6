#pragma once
// Estimates the camera pose from one picture's sighting.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/camera/sighting.h"

#include <optional>
#include <string>
#include <vector>

namespace ar {

enum class PoseFailure {
    none,
    too_few_points, ///< fewer than 4 finite and distinct points
    on_a_line,      ///< all points on one line
    no_agreement,   ///< no pose agrees with at least 4 points and half of all points
    undetermined    ///< the agreeing points leave a degree of freedom undetermined
};
std::string name_of(PoseFailure failure);

struct PoseEstimate {
    PoseFailure failure = PoseFailure::too_few_points;
    /// The members below are valid only if `failure` is none, except for the counts.
    gi::RigidPose world_from_camera;
    double rms_px = 0; ///< root mean square of the reprojection errors of the points used
    int points_used = 0;
    int points_rejected = 0; ///< not finite, or outliers; used + rejected = all points
    std::vector<int> markers_used;
    std::vector<int> markers_rejected; ///< markers without a used point
    /// Covariance of position in the world (m) and rotation about the camera's axes (rad): the inverse of the
    /// points' information matrix (by their sigma_px), times the variance of the residuals if that exceeds 1.
    cv::Matx66d covariance = cv::Matx66d::zeros();
    glm::dvec3 position_sigma_m{0};   ///< along the world's axes
    glm::dvec3 rotation_sigma_deg{0}; ///< about the camera's axes
    /// Second solution for planar points, if it differs by more than half a degree from the first.
    std::optional<gi::RigidPose> other;
    cv::Matx66d other_covariance = cv::Matx66d::zeros(); ///< of the other pose, as `covariance`
    double other_rms_px = 0;
    /// Likelihood of the other pose: exp(-d/2) / (1 + exp(-d/2)), d = difference of their chi^2. 0 to 1; above 0.5
    /// only if `last` selected the pose that fits the picture less well.
    double other_likelihood = 0;
    bool ambiguous = false; ///< other_likelihood > 0.01
    /// 0..1: share of points used, times min(1, 2 / residuals in sigmas), times (1 - other_likelihood; at least
    /// 0.5 where `last` decided), over 1 + (largest standard deviation of the rotation in degrees)^2.
    double confidence = 0;
    double fit = 0; ///< the first two factors of the confidence
    std::optional<double> expected_error_m; ///< of the position, see ar/pose/expected_error.h
    double distance_m = 0;                  ///< from the camera to the middle of the points used

    bool found() const { return failure == PoseFailure::none; }
};

/// PoseEstimate::confidence. @param likelihood  of the pose against others
double confidence_of(double fit, double likelihood, glm::dvec3 const& rotation_sigma_deg);

/// Takes initial estimates from all points and from single markers (IPPE, SQPnP), and selects by the number of
/// agreeing points. Then refines robustly, rejects whole markers and single points that disagree (by 5 sigmas;
/// more, up to 25, if all points are worse than their sigmas suggest), and refines the rest by least squares.
/// @param last recent camera pose: decides between two poses that fit the picture equally well (`ambiguous`),
///             and is a further initial estimate
PoseEstimate estimate_pose(Sighting const& sighting, CameraModel const& camera,
                           std::optional<gi::RigidPose> const& last = std::nullopt);

} // namespace ar
