#pragma once
// Sessions in which everything is known, for `lightwell ar synthesize`: a camera with a lens, noise and a
// trajectory through a room that the reference renderer renders, with and without the virtual objects.

#include "ar/camera/camera_model.h"
#include "ar/camera/photometry.h"
#include "ar/camera/pose.h"
#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "gi/scene/model/scene.h"

#include <opencv2/core.hpp>

namespace ar {

/// A sheet of paper lying on the table, its upper edge away from the camera.
struct PaperOnTable {
    cv::Mat print; ///< CV_8UC1, upper row first; empty = no paper
    double width_m = 0, depth_m = 0;
    glm::dvec2 near_left_m{0}; ///< x and z of its lower left corner
};

/// Part of the room that is modelled; the compositor only ever gets `near`.
enum class DeskPart {
    whole, ///< walls, window, lamp, table, things on it, paper
    near,  ///< the table and the objects on it, which receive shadows and light of virtual objects
};

/// What lies on the table.
enum class TableCloth {
    none,
    printed ///< a cloth with a random pattern of squares of many sizes, for tracking without markers
};

gi::Scene generate_desk(DeskPart part, PaperOnTable const& paper, TableCloth cloth = TableCloth::none);

/// A figure 0.36 m tall that walks in place, and a red ball; both stand on y = 0.
gi::Scene generate_statue();

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
