// What a headset's eye sees of a plane that a camera sees too.

#include "viewer/devices/gl/pass_through_pass.h"

#include <gtest/gtest.h>
#include <random>

namespace viewer::test {
namespace {

TEST(PassThrough, PixelsOfAnEyeAreThoseOfTheCameraForPointsOfThePlane)
{
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> u(-1, 1);
    ar::CameraModel camera;
    camera.size_px = {640, 480};
    camera.fx = 500;
    camera.fy = 510;
    camera.cx = 322;
    camera.cy = 238;
    double worst_px = 0;
    for (int trial = 0; trial < 200; ++trial) {
        auto const pose = [&] {
            return gi::RigidPose{{u(rng), u(rng), u(rng)}, glm::normalize(glm::dquat(5, u(rng), u(rng), u(rng)))};
        };
        gi::RigidPose const room_from_camera = pose();
        double const plane_m = 1.5 + u(rng) * 0.3;
        // Near the camera, and turned from it as a head turns.
        gi::RigidPose const eye_pose =
            room_from_camera * gi::RigidPose{glm::dvec3(u(rng), u(rng), u(rng)) * 0.1,
                                             glm::normalize(glm::dquat(8, u(rng), u(rng), u(rng)))};
        gi::Camera eye;
        eye.off_axis = gi::ViewTangents{-1.1 + 0.1 * u(rng), 0.9, -1, 1.05};
        glm::ivec2 const eye_px(320, 360);
        glm::dmat3 const axes = glm::mat3_cast(eye_pose.rotation) * glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1);
        eye.world_from_camera = glm::dmat4(axes);
        eye.world_from_camera[3] = glm::dvec4(eye_pose.position, 1);
        glm::dmat3 const m = pinhole_from_eye(eye, eye_px, camera, room_from_camera, plane_m);

        glm::dvec3 const in_camera(0.3 * u(rng), 0.3 * u(rng), plane_m);
        glm::dvec3 const in_eye = glm::transpose(axes) * ((room_from_camera * in_camera) - eye_pose.position);
        ASSERT_LT(in_eye.z, 0);
        gi::ViewTangents const t = *eye.off_axis;
        glm::dvec2 const eye_at((-in_eye.x / in_eye.z - t.left) / (t.right - t.left) * eye_px.x,
                                (t.top + in_eye.y / in_eye.z) / (t.top - t.bottom) * eye_px.y);
        glm::dvec3 const found = m * glm::dvec3(eye_at, 1);
        ASSERT_GT(found.z, 0);
        glm::dvec2 const expected = *ar::project(camera, in_camera);
        worst_px = std::max(worst_px, glm::length(glm::dvec2(found) / found.z - expected));
        // What is behind the camera is seen by nobody.
        glm::dvec3 const back = m * glm::dvec3(eye_at, 1) * -1.0;
        EXPECT_LT(back.z, 0);
    }
    EXPECT_LT(worst_px, 1e-8);
}

} // namespace
} // namespace viewer::test
