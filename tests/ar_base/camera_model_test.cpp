#include "ar/camera/camera_model.h"

#include "ar/camera/camera_doubts.h"
#include "ar/camera/pose.h"
#include "gi/core/error.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <opencv2/calib3d.hpp>

namespace ar::test {
namespace {

CameraModel camera(LensModel lens)
{
    CameraModel c{lens, {640, 480}, 525, 530, 318.5, 243.25, {}};
    if (lens == LensModel::radial_tangential) c.distortion = {-0.28, 0.09, 0.001, -0.0007, -0.01};
    if (lens == LensModel::rational) c.distortion = {0.4, 0.1, 0.0005, -0.0003, 0.02, 0.7, 0.2, 0.03};
    if (lens == LensModel::fisheye) c.distortion = {0.03, -0.01, 0.004, -0.001};
    return c;
}

class Lens : public testing::TestWithParam<LensModel> {};
INSTANTIATE_TEST_SUITE_P(All, Lens,
                         testing::Values(LensModel::pinhole, LensModel::radial_tangential, LensModel::rational,
                                         LensModel::fisheye),
                         [](auto const& p) { return name_of(p.param); });

TEST_P(Lens, IsThatOfOpenCv)
{
    CameraModel const c = camera(GetParam());
    for (double x = -0.7; x <= 0.7; x += 0.2)
        for (double y = -0.5; y <= 0.5; y += 0.25) {
            glm::dvec3 const point(2 * x, 2 * y, 2);
            std::vector<cv::Point3d> const in{{point.x, point.y, point.z}};
            std::vector<cv::Point2d> out;
            cv::Mat const none = cv::Mat::zeros(3, 1, CV_64F);
            if (GetParam() == LensModel::fisheye)
                cv::fisheye::projectPoints(in, out, none, none, camera_matrix(c), distortion_of(c));
            else
                cv::projectPoints(in, none, none, camera_matrix(c), distortion_of(c), out);
            auto const p = project(c, point);
            ASSERT_TRUE(p);
            EXPECT_NEAR(p->x, out[0].x, 1e-9);
            EXPECT_NEAR(p->y, out[0].y, 1e-9);
        }
}

TEST_P(Lens, DirectionsProjectBack)
{
    CameraModel const c = camera(GetParam());
    check(c, "camera");
    for (int y = 0; y < 480; y += 13)
        for (int x = 0; x < 640; x += 13) {
            auto const d = direction_of(c, {x, y});
            ASSERT_TRUE(d) << x << " " << y;
            EXPECT_NEAR(glm::length(*d), 1, 1e-12);
            auto const p = project(c, *d);
            ASSERT_TRUE(p);
            EXPECT_NEAR(p->x, x, 1e-8);
            EXPECT_NEAR(p->y, y, 1e-8);
        }
}

TEST_P(Lens, NameComesBack) { EXPECT_EQ(lens_named(name_of(GetParam())), GetParam()); }

TEST(CameraModels, SeeNothingBehindThem)
{
    EXPECT_FALSE(project(camera(LensModel::pinhole), {0, 0, -1}));
    EXPECT_FALSE(project(camera(LensModel::rational), {0.1, 0, 0}));
    EXPECT_TRUE(project(camera(LensModel::fisheye), {1, 0, -0.1})); // more than 180 degrees
    EXPECT_FALSE(project(camera(LensModel::fisheye), {0, 0, 0}));
}

TEST(CameraModels, OfAnotherSizeSeeTheSame)
{
    CameraModel const c = camera(LensModel::radial_tangential), half = scaled(c, {320, 240});
    glm::dvec3 const point(0.3, -0.2, 1);
    glm::dvec2 const a = *project(c, point), b = *project(half, point);
    EXPECT_NEAR((a.x + 0.5) / 2 - 0.5, b.x, 1e-9);
    EXPECT_NEAR((a.y + 0.5) / 2 - 0.5, b.y, 1e-9);
}

TEST(CameraModels, TablesUndistort)
{
    CameraModel const from = camera(LensModel::radial_tangential);
    CameraModel to = from;
    to.lens = LensModel::pinhole;
    to.distortion = {};
    cv::Mat const table = remap_table(to, from);
    auto const p = project(from, *direction_of(to, {100, 50}));
    EXPECT_NEAR(table.at<cv::Vec2f>(50, 100)[0], p->x, 1e-4);
    EXPECT_NEAR(table.at<cv::Vec2f>(50, 100)[1], p->y, 1e-4);
}

TEST(CameraModels, ThatCannotBeAreRefused)
{
    auto const refused = [](auto const& change) {
        CameraModel c = camera(LensModel::radial_tangential);
        change(c);
        EXPECT_THROW(check(c, "c.yaml"), gi::InputError);
    };
    refused([](CameraModel& c) { c.fx = 0; });
    refused([](CameraModel& c) { c.fy = -500; });
    refused([](CameraModel& c) { c.cx = std::numeric_limits<double>::quiet_NaN(); });
    refused([](CameraModel& c) { c.cx = 5000; });
    refused([](CameraModel& c) { c.size_px = {0, 480}; });
    refused([](CameraModel& c) { c.distortion[0] = -3; });
    refused([](CameraModel& c) { c.distortion[7] = std::numeric_limits<double>::infinity(); });
}

TEST(Poses, AreThoseOfRodrigues)
{
    for (cv::Vec3d const& r : {cv::Vec3d(0, 0, 0), cv::Vec3d(1e-10, 0, 2e-10), cv::Vec3d(0.3, -1.2, 0.7),
                               cv::Vec3d(0, 3.1415, 0), cv::Vec3d(1.8, 1.8, -1.8)}) {
        gi::RigidPose const p = pose_of(r, {1, 2, 3});
        cv::Matx33d m;
        cv::Rodrigues(r, m);
        cv::Vec3d const expected = m * cv::Vec3d(0.5, -2, 1);
        glm::dvec3 const got = p.rotation * glm::dvec3(0.5, -2, 1);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], expected[i], 1e-12);
        cv::Vec3d const back = rotation_vector(p);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(back[i], r[i], 1e-9);
        glm::dvec3 const there_and_back = inverse(p) * (p * glm::dvec3(4, 5, 6));
        EXPECT_NEAR(glm::length(there_and_back - glm::dvec3(4, 5, 6)), 0, 1e-12);
        EXPECT_NEAR(angle_between_deg((p * inverse(p)).rotation, {1, 0, 0, 0}), 0, 1e-6);
    }
    EXPECT_NEAR(angle_between_deg(pose_of({0, 0, 0.1}, {}).rotation, pose_of({0, 0, -0.1}, {}).rotation),
                glm::degrees(0.2), 1e-9);
}

TEST(CameraDoubts, AreAboutNumbersThatNoUsualCameraHas)
{
    auto const of = [](double fx, double fy, double cx, double cy, LensModel lens = LensModel::pinhole) {
        return doubts_about(CameraModel{lens, {640, 480}, fx, fy, cx, cy, {}});
    };
    EXPECT_TRUE(of(550, 555, 322, 236).empty());
    EXPECT_TRUE(of(200, 200, 300, 260).empty()) << "wide";
    EXPECT_TRUE(of(20000, 20000, 319, 239).empty()) << "far";
    EXPECT_TRUE(of(60, 60, 319, 239, LensModel::fisheye).empty());
    EXPECT_EQ(of(4.2, 4.2, 322, 236).size(), 1u) << "millimetres";
    EXPECT_EQ(of(4e5, 4e5, 322, 236).size(), 1u);
    EXPECT_EQ(of(550, 400, 322, 236).size(), 1u) << "not square";
    EXPECT_TRUE(of(550, 550, 350, 200).empty());
    EXPECT_EQ(of(550, 550, 320, 420).size(), 1u) << "cy of another picture";
    EXPECT_EQ(of(550, 550, 236.8, 322.4).size(), 1u) << "exchanged";
    EXPECT_EQ(of(1100, 1100, 640, 480).size(), 1u) << "of twice the size";
}

} // namespace
} // namespace ar::test
