#include "viewer/devices/gl/pass_through_pass.h"

#include "ar/composite/warp.h"
#include "viewer/devices/gl/fill_texture.h"

#include <epoxy/gl.h>

namespace viewer {

glm::dmat3 pinhole_from_eye(gi::Camera const& eye, glm::ivec2 eye_px, ar::CameraModel const& c,
                            gi::RigidPose const& room_from_camera, double plane_m)
{
    gi::ViewTangents const t = eye.off_axis.value_or(gi::ViewTangents{-1, 1, -1, 1});
    // Columns: contributions of one pixel right, one pixel down, and the corner to the direction.
    glm::dmat3 const direction_of_pixel(glm::dvec3((t.right - t.left) / eye_px.x, 0, 0),
                                        glm::dvec3(0, -(t.top - t.bottom) / eye_px.y, 0),
                                        glm::dvec3(t.left, t.top, -1));
    glm::dmat3 const camera_from_room = glm::transpose(glm::mat3_cast(room_from_camera.rotation));
    glm::dvec3 const origin =
        camera_from_room * (glm::dvec3(eye.world_from_camera[3]) - room_from_camera.position);
    // A ray o + s d meets z = plane at s = (plane - o.z) / d.z; all times d.z.
    double const ahead_m = plane_m - origin.z;
    glm::dmat3 const on_plane(glm::dvec3(ahead_m, 0, 0), glm::dvec3(0, ahead_m, 0),
                              glm::dvec3(origin.x, origin.y, plane_m));
    glm::dmat3 const pinhole(glm::dvec3(c.fx, 0, 0), glm::dvec3(0, c.fy, 0), glm::dvec3(c.cx, c.cy, 1));
    return pinhole * on_plane * camera_from_room * glm::dmat3(eye.world_from_camera) * direction_of_pixel;
}

PassThroughPass::PassThroughPass(ar::CameraModel const& camera)
    : pinhole_(ar::covering_pinhole(camera)),
      size_px_(camera.size_px),
      program_({"full_screen.vert"}, {"pass_through.frag"}),
      picture_(texture_2d(GL_RGBA8, camera.size_px, GL_LINEAR)),
      lens_(texture_2d(GL_RG32F, pinhole_.size_px, GL_LINEAR))
{
    fill_texture(lens_, ar::remap_table(pinhole_, camera), GL_RG, GL_FLOAT);
    fill_texture(picture_, cv::Mat::zeros(size_px_.y, size_px_.x, CV_8UC3), GL_RGB, GL_UNSIGNED_BYTE);
}

void PassThroughPass::take(cv::Mat const& rgb)
{
    CV_Assert(rgb.type() == CV_8UC3 && rgb.cols == size_px_.x && rgb.rows == size_px_.y);
    fill_texture(picture_, rgb, GL_RGB, GL_UNSIGNED_BYTE);
}

void PassThroughPass::draw(DrawTarget const& target, gi::Camera const& eye, gi::RigidPose const& room_from_camera,
                           double plane_m)
{
    bind(target);
    program_.use();
    program_.set("pinhole_from_eye",
                 glm::mat3(pinhole_from_eye(eye, target.size_px, pinhole_, room_from_camera, plane_m)));
    glBindVertexArray(vertices_.id());
    glBindTextureUnit(0, picture_.id());
    glBindTextureUnit(1, lens_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindTextureUnit(0, 0);
    glBindTextureUnit(1, 0);
    glBindVertexArray(0);
}

} // namespace viewer
