#include "tests/ar_composite/region.h"
#include "tests/ar_composite/test_pictures.h"

#include <gtest/gtest.h>
#include <limits>

namespace ar::test {
namespace {

TEST(AffectedRegion, IsWhereSomethingChanged)
{
    RenderedPair pair = unchanged_pair({40, 30});
    EXPECT_EQ(cv::countNonZero(affected_region(pair)), 0);
    pair.coverage.at<float>(5, 5) = 0.01f;
    pair.with.at<cv::Vec3f>(15, 20) *= 1.5f;
    pair.with.at<cv::Vec3f>(25, 30) *= 1.001f;
    pair.with.at<cv::Vec3f>(2, 35)[1] = std::numeric_limits<float>::quiet_NaN();
    cv::Mat const exact = affected_region(pair, 0.02, 0);
    EXPECT_EQ(cv::countNonZero(exact), 3);
    EXPECT_EQ(exact.at<uchar>(5, 5), 255);
    EXPECT_EQ(exact.at<uchar>(15, 20), 255);
    EXPECT_EQ(exact.at<uchar>(2, 35), 255);
    EXPECT_EQ(cv::countNonZero(affected_region(pair, 0.02, 1)), 15);
    EXPECT_EQ(cv::countNonZero(affected_region(pair, 0.0001, 0)), 4);
}

TEST(RegionErrors, AreApart)
{
    cv::Mat const a = camera_frame({40, 30});
    cv::Mat b = a.clone(), region = cv::Mat::zeros(30, 40, CV_8UC1);
    region.colRange(0, 10) = 255;
    b.at<cv::Vec3b>(3, 3)[0] ^= 4;
    b.at<cv::Vec3b>(7, 30)[2] ^= 1;
    CompositeError const e = errors_of(a, b, region);
    EXPECT_EQ(e.inside.pixels, 300u);
    EXPECT_EQ(e.inside.largest, 4);
    EXPECT_EQ(e.inside.differing, 1u);
    EXPECT_NEAR(e.inside.rms, 4 / std::sqrt(900.0), 1e-12);
    EXPECT_NEAR(e.outside.mean_absolute, 1 / 2700.0, 1e-12);
    EXPECT_THROW(errors_of(a, b, cv::Mat()), gi::InputError);
}

} // namespace
} // namespace ar::test
