#pragma once
// Poses by least squares on what the picture shows: the reprojection error through the whole lens model, in pixels
// of the picture as it came, each point in units of its sigma_px.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/camera/sighting.h"

#include <optional>
#include <span>

namespace ar {

/// Pixel that `world_from_camera` would show minus pixel seen; nothing if the point is not ahead of the camera.
std::optional<glm::dvec2> miss_px(CameraModel const& camera, Pose const& world_from_camera, SightedPoint const& p);
/// The length of the miss in units of sigma_px; 1e9 where there is none.
double miss_sigmas(CameraModel const& camera, Pose const& world_from_camera, SightedPoint const& point);

struct Refined {
    Pose world_from_camera;
    double chi2 = 0; ///< sum of the squared misses in sigmas
    /// (J^T W J)^-1 of position in the world (m) and rotation about the camera's axes (rad), for the sigmas as
    /// given. Nothing if the points do not determine the pose.
    std::optional<cv::Matx66d> covariance;
};

/// Levenberg-Marquardt (Levenberg 1944, Marquardt 1963); the rotation is updated by rotation vectors.
/// @param start a pose that has the points ahead of the camera
/// @param robust_sigmas if > 0: weights of Geman and McClure 1987 with this scale, by iterated reweighting,
/// roughly:
///        points far beyond it hardly count
Refined refine(CameraModel const& camera, std::span<SightedPoint const> points, Pose const& start,
               double robust_sigmas = 0);

} // namespace ar
