#pragma once
// A camera's picture as an eye sees it that is somewhere else and looks elsewhere by now: the picture stands on a
// plane across the camera's axis, where the camera was when it was taken. Turning of the head is made up for
// exactly, moving only for what is at that distance.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "gi/scene/model/camera.h"
#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/gl_program.h"

namespace viewer {

/// From the pixels of an eye (from its top left corner) to those of a pinhole camera (middles have whole numbers),
/// homogeneous; the third is above 0 where the camera looks.
/// @param eye  with an off-axis lens   @param room_from_camera  x right, y down, z ahead
glm::dmat3 pinhole_from_eye(gi::Camera const& eye, glm::ivec2 eye_px, ar::CameraModel const& pinhole,
                            ar::Pose const& room_from_camera, double plane_m);

/// Belongs to the context that was current when it was made.
class PassThroughPass {
public:
    explicit PassThroughPass(ar::CameraModel const& camera);
    /// @param rgb  CV_8UC3, of the camera's size
    void take(cv::Mat const& rgb);
    void draw(DrawTarget const& target, gi::Camera const& eye, ar::Pose const& room_from_camera, double plane_m);

private:
    ar::CameraModel pinhole_;
    glm::ivec2 size_px_;
    GlProgram program_;
    GlObject vertices_{GlObject::Kind::vertex_array};
    GlObject picture_, lens_;
};

} // namespace viewer
