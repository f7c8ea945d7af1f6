#pragma once
// Sessions in which everything is known, for `lightwell ar synthesize`: a camera with a lens, noise and a
// trajectory through a room that the reference renderer renders, with and without the virtual objects.

#include "ar/camera/camera_model.h"
#include "ar/camera/photometry.h"
#include "ar/camera/pose.h"
#include "ar/pipeline/desk.h"
#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "gi/scene/model/scene.h"

namespace ar {

struct SyntheticCamera {
    CameraModel model;
    Photometry photometry;
    double read_noise = 0.0015; ///< standard deviation, units of the photometry
    double photon_noise = 2e-5; ///< variance per unit
};

/// 60 degrees wide at 640 x 480, barrel distortion; sRGB bytes.
SyntheticCamera synthetic_camera(glm::ivec2 size_px);

/// Camera pose around the middle of the table at a distance of about 1 m, above it: smooth, with a little handheld
/// sway. @param t  0 to 1
gi::RigidPose synthetic_pose(double t);
/// Another way around the table, nearer and faster, for tracking by a map that was made along the first.
gi::RigidPose synthetic_pose_apart(double t);

struct SyntheticQuality {
    std::uint32_t paths = 4;  ///< of the reference renderer, per pixel of the camera
    double resolution = 1.25; ///< pixels rendered per pixel of the camera, before the lens
    bool denoise = true;
    int threads = 0;
};

/// Radiance, CV_32FC3, of the camera's size, through its lens.
/// @param seed  with the same seed, the common parts of two scenes have the same noise
cv::Mat synthetic_radiance(gi::Scene const& scene, std::optional<double> time_s, CameraModel const& camera,
                           gi::RigidPose const& world_from_camera, SyntheticQuality const& quality,
                           std::uint64_t seed, gi::StopRequest const& stop, gi::Report& report);

/// Simulates the sensor: CV_8UC3 RGB. The noise depends only on the frame number.
cv::Mat synthetic_frame(cv::Mat const& radiance, SyntheticCamera const& camera, std::uint64_t frame);

/// Exact light probe at this place: lat-long radiance, CV_32FC3, 2 height x height.
cv::Mat synthetic_probe(gi::Scene const& scene, gi::dvec3 place_m, int height, SyntheticQuality const& quality,
                        gi::StopRequest const& stop, gi::Report& report);

} // namespace ar
