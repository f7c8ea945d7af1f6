#include "ar/composite/warp.h"

#include "ar/composite/composite.h"
#include "gi/core/error.h"
#include "tests/ar_composite/test_pictures.h"

#include <cmath>
#include <gtest/gtest.h>

namespace ar::test {
namespace {

CameraModel camera(LensModel lens)
{
    CameraModel c{lens, {160, 120}, 130, 132, 81, 58, {}};
    if (lens == LensModel::radial_tangential) c.distortion = {-0.25, 0.06, 0.001, -0.002, 0.003};
    if (lens == LensModel::rational) c.distortion = {0.4, -0.1, 0.0005, 0.001, 0.01, 0.7, -0.05, 0.002};
    if (lens == LensModel::fisheye) c.distortion = {-0.02, 0.005, -0.001, 0.0001};
    return c;
}

/// A smooth function of the direction.
cv::Vec3f light_from(glm::dvec3 d)
{
    return {float(0.5 + 0.4 * d.x), float(0.5 + 0.4 * d.y), float(0.3 + 0.5 * d.z * d.x)};
}

cv::Mat picture_of(CameraModel const& c)
{
    cv::Mat picture(c.size_px.y, c.size_px.x, CV_32FC3);
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) picture.at<cv::Vec3f>(y, x) = light_from(*direction_of(c, {x, y}));
    return picture;
}

class Warps : public ::testing::TestWithParam<LensModel> {};

TEST_P(Warps, BringPinholePicturesIntoTheLens)
{
    CameraModel const lens = camera(GetParam());
    for (double const resolution : {0.5, 1.0, 1.5}) {
        CameraModel const pinhole = covering_pinhole(lens, resolution);
        check(pinhole, "pinhole");
        Warp const warp(lens, pinhole);
        EXPECT_EQ(warp.unseen_px(), 0);
        EXPECT_LT(cv::norm(warp.smooth(picture_of(pinhole)), picture_of(lens), cv::NORM_INF), 2e-4 / resolution);
        // Not much more than needed: a border of 6 pixels less would not do.
        CameraModel less = pinhole;
        less.size_px -= 12;
        less.cx -= 6;
        less.cy -= 6;
        EXPECT_GT(Warp(lens, less).unseen_px(), 0);
    }
}

TEST_P(Warps, KeepWhatIsEqualEqual)
{
    CameraModel const lens = camera(GetParam());
    Warp const warp(lens, covering_pinhole(lens));
    cv::Size const size(warp.from().size_px.x, warp.from().size_px.y);
    cv::Mat const frame = camera_frame({160, 120});
    cv::Mat out;
    CompositeCounts const counts = Compositor(srgb_photometry())(frame, warp(unchanged_pair(size)), {}, out);
    EXPECT_TRUE(equal(out, frame));
    EXPECT_EQ(counts.copied, frame.total());
}

INSTANTIATE_TEST_SUITE_P(Lenses, Warps,
                         ::testing::Values(LensModel::pinhole, LensModel::radial_tangential, LensModel::rational,
                                           LensModel::fisheye),
                         [](auto const& lens) { return name_of(lens.param); });

TEST(Warp, OfTheSameCameraCopiesNothing)
{
    CameraModel const c = camera(LensModel::pinhole);
    cv::Mat const picture = picture_of(c);
    EXPECT_EQ(Warp(c, c).smooth(picture).data, picture.data);
}

TEST(Warp, SaysWhatIsNotSeen)
{
    CameraModel const lens = camera(LensModel::radial_tangential);
    CameraModel narrow{LensModel::pinhole, {160, 120}, 130, 132, 81, 58, {}};
    Warp const warp(lens, narrow);
    EXPECT_GT(warp.unseen_px(), 100);
    EXPECT_LT(warp.unseen_px(), 160 * 120 / 3);
    cv::Mat const ones(120, 160, CV_32FC1, cv::Scalar(1));
    EXPECT_EQ(warp.nearest(ones).at<float>(0, 0), 0);
    EXPECT_THROW(warp.smooth(ones.colRange(0, 100)), gi::InputError);
}

TEST(CoveringPinhole, RefusesWhatNoPlaneHolds)
{
    CameraModel c{LensModel::fisheye, {640, 480}, 200, 200, 320, 240, {}};
    EXPECT_THROW(covering_pinhole(c), gi::InputError);
    EXPECT_THROW(covering_pinhole(camera(LensModel::pinhole), 0), gi::InputError);
    EXPECT_THROW(covering_pinhole(camera(LensModel::pinhole), 200), gi::InputError);
}

} // namespace
} // namespace ar::test
