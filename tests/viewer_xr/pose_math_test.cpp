#include "gi/scene/model/projection.h"
#include "viewer/devices/xr/pose_math.h"

#include <gtest/gtest.h>
#include <random>

namespace viewer::test {
namespace {

gi::dquat turned(double degrees, gi::dvec3 axis) { return glm::angleAxis(glm::radians(degrees), axis); }

class RandomPoses {
public:
    RoomPose operator()()
    {
        gi::dquat const q(normal_(bits_), normal_(bits_), normal_(bits_), normal_(bits_));
        return {{normal_(bits_), normal_(bits_), normal_(bits_)}, glm::normalize(q)};
    }

private:
    std::mt19937 bits_{20250701};
    std::normal_distribution<double> normal_;
};

TEST(PoseMath, CompositionIsTheProductOfMatrices)
{
    RandomPoses pose;
    for (int i = 0; i < 100; ++i) {
        RoomPose const a = pose(), b = pose();
        gi::dmat4 const m = eye_camera(HmdEye::left, a, {-1, 1, -1, 1}).world_from_camera *
                            eye_camera(HmdEye::left, b, {-1, 1, -1, 1}).world_from_camera;
        gi::dmat4 const expected = eye_camera(HmdEye::left, a * b, {-1, 1, -1, 1}).world_from_camera;
        for (int c = 0; c < 4; ++c) EXPECT_LT(glm::distance(m[c], expected[c]), 1e-12);
    }
}

TEST(PoseMath, HeadingCountsFromAbove)
{
    gi::dvec3 const up(0, 1, 0), right(1, 0, 0);
    EXPECT_NEAR(heading_rad(turned(0, up)), 0, 1e-12);
    EXPECT_NEAR(heading_rad(turned(37, up)), glm::radians(37.0), 1e-12);
    EXPECT_NEAR(heading_rad(turned(-150, up)), glm::radians(-150.0), 1e-12);
    EXPECT_NEAR(heading_rad(turned(37, up) * turned(60, right)), glm::radians(37.0), 1e-12) << "looks up";
    EXPECT_NEAR(heading_rad(turned(37, up) * turned(90, right)), glm::radians(37.0), 1e-9) << "straight up";
    EXPECT_NEAR(heading_rad(turned(37, up) * turned(-90, right)), glm::radians(37.0), 1e-9) << "straight down";
}

TEST(PoseMath, CentredHeadFacesAhead)
{
    RandomPoses pose;
    for (int i = 0; i < 1000; ++i) {
        RoomPose const head = pose();
        RoomPose const now = centred(head, 1.6) * head;
        EXPECT_NEAR(now.position.x, 0, 1e-12);
        EXPECT_NEAR(now.position.z, 0, 1e-12);
        EXPECT_NEAR(now.position.y, head.position.y + 1.6, 1e-12);
        EXPECT_NEAR(heading_rad(now.rotation), 0, 1e-9);
    }
}

TEST(PoseMath, QuaternionsOfNoLengthAreNoRotation)
{
    EXPECT_EQ(pose_of({0, 0, 0, 0}, {1, 2, 3}), (RoomPose{{1, 2, 3}, {1, 0, 0, 0}}));
    EXPECT_EQ(pose_of({NAN, 0, 0, 1}, {1, 2, 3}).rotation, gi::dquat(1, 0, 0, 0));
}

/// What a runtime says of the edges of a view is where points at those angles are seen.
TEST(PoseMath, AnglesAreTheEdgesOfThePicture)
{
    HmdRawView raw;
    raw.fov_rad = {-0.9f, 0.7f, 0.6f, -0.8f};
    ASSERT_TRUE(spans_view(raw));
    RoomPose const room_from_eye{{1, 1.7, -2}, turned(30, {0, 1, 0})};
    gi::Camera const camera = eye_camera(HmdEye::right, room_from_eye, tangents(raw));
    gi::CameraRays const rays = gi::camera_rays(camera, 100, 80, gi::dvec3(0));
    auto const seen_at = [&](double x_rad, double y_rad) {
        gi::dvec3 const in_eye(3 * std::tan(x_rad), 3 * std::tan(y_rad), -3);
        return gi::Projection(rays)(gi::vec3(room_from_eye.position + room_from_eye.rotation * in_eye));
    };
    EXPECT_NEAR(seen_at(-0.9, 0).x, 0, 1e-3);
    EXPECT_NEAR(seen_at(0.7, 0).x, 100, 1e-3);
    EXPECT_NEAR(seen_at(0, 0.6).y, 0, 1e-3);
    EXPECT_NEAR(seen_at(0, -0.8).y, 80, 1e-3);
}

TEST(PoseMath, ViewsWithoutExtentAreNone)
{
    HmdRawView raw;
    EXPECT_FALSE(spans_view(raw)) << "all zero, as some runtimes have it at first";
    raw.fov_rad = {0.7f, -0.7f, 0.6f, -0.6f};
    EXPECT_FALSE(spans_view(raw)) << "left is right";
    raw.fov_rad = {-0.7f, 1.6f, 0.6f, -0.6f};
    EXPECT_FALSE(spans_view(raw)) << "beyond a right angle";
    raw.fov_rad = {-0.7f, 0.7f, NAN, -0.6f};
    EXPECT_FALSE(spans_view(raw));
    raw.fov_rad = {0.1f, 0.7f, 0.6f, 0.2f};
    EXPECT_TRUE(spans_view(raw)) << "need not hold the axis";
}

} // namespace
} // namespace viewer::test
