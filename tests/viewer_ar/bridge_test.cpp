#include "ar/pipeline/bridge.h"

#include "ar/pipeline/synthetic.h"

#include <limits>

namespace viewer::test {
namespace {

TEST(GiCameras, SeeThroughThePixelsOfArCameras)
{
    ar::CameraModel pinhole;
    pinhole.size_px = {640, 480};
    pinhole.fx = 520;
    pinhole.fy = 530;
    pinhole.cx = 300.5;
    pinhole.cy = 250.25;
    gi::RigidPose const pose = ar::synthetic_pose(0.3);
    gi::CameraRays const rays = gi::camera_rays(ar::gi_camera(pinhole, pose), 640, 480, gi::dvec3(0));
    for (glm::dvec2 const pixel : {glm::dvec2(0, 0), glm::dvec2(639, 479), glm::dvec2(320.25, 17.5)}) {
        glm::dvec3 const expected = pose.rotation * *ar::direction_of(pinhole, pixel);
        gi::Ray const ray = rays.through(gi::vec2(pixel) + 0.5f); // pixel centres lie at + 0.5 there
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(ray.direction[i], expected[i], 1e-6);
            EXPECT_NEAR(ray.origin[i], pose.position[i], 1e-6);
        }
    }
}

TEST(Environments, KeepTheirTexels)
{
    cv::Mat map(2, 4, CV_32FC3, cv::Scalar(1, 2, 3));
    map.at<cv::Vec3f>(1, 2) = {4, -1, std::numeric_limits<float>::quiet_NaN()};
    gi::EnvironmentMap const environment = ar::environment_of(map);
    ASSERT_EQ(environment.radiance.size(), 8u);
    EXPECT_EQ(environment.radiance[0], gi::vec3(1, 2, 3));
    EXPECT_EQ(environment.radiance[6], gi::vec3(4, 0, 0));
    EXPECT_EQ(environment.radiance[3], gi::vec3(1, 2, 3));
}

} // namespace
} // namespace viewer::test
