#pragma once
// Refines poses by least squares of the reprojection error through the whole lens model, in pixels of the original
// (distorted) picture, each point in units of its sigma_px.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/camera/sighting.h"

#include <optional>
#include <span>

namespace ar {

/// Projected minus observed pixel; nothing if the point is not in front of the camera.
std::optional<glm::dvec2> miss_px(CameraModel const& camera, gi::RigidPose const& world_from_camera,
                                  SightedPoint const& p);
/// Length of `miss_px` in units of sigma_px; 1e9 if there is none.
double miss_sigmas(CameraModel const& camera, gi::RigidPose const& world_from_camera, SightedPoint const& point);

struct Refined {
    gi::RigidPose world_from_camera;
    double chi2 = 0; ///< sum of squared misses in sigmas
    /// (J^T W J)^-1 of position in the world (m) and rotation about the camera's axes (rad), for the points'
    /// sigma_px. Nothing if the points do not determine the pose.
    std::optional<cv::Matx66d> covariance;
};

/// Levenberg-Marquardt (Levenberg 1944, Marquardt 1963); the rotation is updated by rotation vectors.
/// @param start a pose with the points in front of the camera
/// @param robust_sigmas if > 0: weights of Geman and McClure 1987 with this scale, by iterative reweighting to low
///        precision: points far beyond it have almost no weight
Refined refine(CameraModel const& camera, std::span<SightedPoint const> points, gi::RigidPose const& start,
               double robust_sigmas = 0);

} // namespace ar
