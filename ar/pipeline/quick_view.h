#pragma once
// Pictures of a scene for tests of tracking: rasterised, lit by a sky without shadows or interreflection.
// A frame costs a small part of a second, where the reference renderer takes minutes;
// edges, textures and the lens are as sharp.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/pipeline/first_surfaces.h"
#include "gi/scene/model/scene.h"

namespace ar {

/// The sky: radiance 0.7 + 0.3 y towards a direction of height y, white.
/// Its lat-long map: CV_32FC3, 2 height x height.
cv::Mat quick_sky(int height);

class QuickView {
public:
    QuickView(gi::Scene const& scene, gi::Report& report);

    /// Radiance reflected by the first surfaces, CV_32FC3 of the camera's size, through its lens; 0 = no surface.
    /// @param samples  points per pixel of the camera, in the mean
    cv::Mat radiance(CameraModel const& camera, gi::RigidPose const& world_from_camera, int samples = 4);

private:
    gi::World world_;
    SurfaceView surfaces_;
};

} // namespace ar
