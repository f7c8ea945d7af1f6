#pragma once
// Sessions in which everything is known: a camera with a lens, noise and a path through a room that the reference
// renderer renders, with and without the virtual things. What `lightwell ar synthesize` writes.

#include "ar/camera/camera_model.h"
#include "ar/camera/photometry.h"
#include "ar/camera/pose.h"
#include "ar/pipeline/desk.h"
#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "gi/scene/model/scene.h"

namespace viewer {

struct SyntheticCamera {
    ar::CameraModel model;
    ar::Photometry photometry;
    double read_noise = 0.0015; ///< standard deviation, units of the photometry
    double photon_noise = 2e-5; ///< variance per unit
};

/// 640 x 480 wide: 60 degrees across, barrel distortion; sRGB bytes.
SyntheticCamera synthetic_camera(glm::ivec2 size_px);

/// Around the middle of the table at about 1 m, above it, handheld: smooth, with a little sway. @param t  0 to 1
ar::Pose synthetic_pose(double t);

struct SyntheticQuality {
    std::uint32_t paths = 48; ///< of the reference renderer, per pixel of the camera
    double resolution = 1.25; ///< pixels rendered per pixel of the camera, before the lens
    bool denoise = true;
    int threads = 0;
};

/// Radiance, CV_32FC3, of the camera's size, through its lens.
/// @param seed  the same for two scenes: what they share has the same noise
cv::Mat synthetic_radiance(gi::Scene const& scene, std::optional<double> time_s, ar::CameraModel const& camera,
                           ar::Pose const& world_from_camera, SyntheticQuality const& quality, std::uint64_t seed,
                           gi::StopRequest const& stop, gi::Report& report);

/// What the sensor makes of it: CV_8UC3 RGB. The same frame has the same noise.
cv::Mat synthetic_frame(cv::Mat const& radiance, SyntheticCamera const& camera, std::uint64_t frame);

/// What a perfect probe at this place sees: lat-long radiance, CV_32FC3, 2 height x height.
cv::Mat synthetic_probe(gi::Scene const& scene, gi::dvec3 place_m, int height, SyntheticQuality const& quality,
                        gi::StopRequest const& stop, gi::Report& report);

} // namespace viewer
