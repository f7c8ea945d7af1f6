#pragma once
// Reprojects a camera's picture to the current pose of an eye: the picture is placed on a plane perpendicular to
// the camera's axis at the pose of its capture. Head rotation is compensated exactly, translation only for objects
// at the plane's distance.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "gi/scene/model/camera.h"
#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/gl_program.h"

namespace viewer {

/// Homography from an eye's pixels (from the top left corner) to those of a pinhole camera (pixel centres are
/// integers); the third homogeneous coordinate is > 0 in front of the camera.
/// @param eye  with an off-axis lens   @param room_from_camera  x right, y down, z ahead
glm::dmat3 pinhole_from_eye(gi::Camera const& eye, glm::ivec2 eye_px, ar::CameraModel const& pinhole,
                            gi::RigidPose const& room_from_camera, double plane_m);

/// Belongs to the context that was current at its creation.
class PassThroughPass {
public:
    explicit PassThroughPass(ar::CameraModel const& camera);
    /// @param rgb  CV_8UC3, of the camera's size
    void take(cv::Mat const& rgb);
    void draw(DrawTarget const& target, gi::Camera const& eye, gi::RigidPose const& room_from_camera,
              double plane_m);

private:
    ar::CameraModel pinhole_;
    glm::ivec2 size_px_;
    GlProgram program_;
    GlObject vertices_{GlObject::Kind::vertex_array};
    GlObject picture_, lens_;
};

} // namespace viewer
