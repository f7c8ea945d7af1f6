#include "ar/camera/photometry.h"

#include "ar/camera/frame.h"
#include "gi/core/error.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

cv::Mat every_byte()
{
    cv::Mat rgb(16, 16, CV_8UC3);
    for (int i = 0; i < 256; ++i)
        rgb.at<cv::Vec3b>(i / 16, i % 16) = cv::Vec3b(uchar(i), uchar(255 - i), uchar(i / 2));
    return rgb;
}

bool equal(cv::Mat const& a, cv::Mat const& b) { return cv::norm(a, b, cv::NORM_INF) == 0; }

TEST(Bytes, ComeBackFromRadiance)
{
    Photometry p = srgb_photometry();
    cv::Mat const rgb = every_byte();
    EXPECT_TRUE(equal(bytes_of(radiance_of(rgb, p), p), rgb));
    p.radiance_per_unit = 37.5;
    p.vignetting = {-0.3, 0.05, -0.01};
    p.reference = {0.01, 1, 0, 0};
    Exposure const longer{0.02, 1.7, 0, 0};
    EXPECT_TRUE(equal(bytes_of(radiance_of(rgb, p, longer), p, longer), rgb));
    p.colour = {1.2f, -0.1f, -0.1f, -0.05f, 1.1f, -0.05f, 0, -0.2f, 1.2f};
    EXPECT_TRUE(equal(bytes_of(radiance_of(rgb, p, longer), p, longer), rgb));
}

TEST(Bytes, AreTheNearest)
{
    Photometry const p = srgb_photometry();
    for (int i = 0; i < 255; ++i) {
        float const a = p.unit_of_byte[0][std::size_t(i)], b = p.unit_of_byte[0][std::size_t(i) + 1];
        cv::Mat const below(1, 1, CV_32FC3, cv::Scalar::all(a + 0.49f * (b - a)));
        cv::Mat const above(1, 1, CV_32FC3, cv::Scalar::all(a + 0.51f * (b - a)));
        EXPECT_EQ(bytes_of(below, p).at<cv::Vec3b>(0)[1], i);
        EXPECT_EQ(bytes_of(above, p).at<cv::Vec3b>(0)[1], i + 1);
    }
}

TEST(Bytes, OfWhatIsNotFinite)
{
    float const nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    cv::Mat const odd(1, 1, CV_32FC3, cv::Scalar(nan, inf, -inf));
    EXPECT_EQ(bytes_of(odd, srgb_photometry()).at<cv::Vec3b>(0), cv::Vec3b(0, 255, 0));
}

TEST(Bytes, OfAFlatResponseDoNotHang)
{
    Photometry p = srgb_photometry();
    for (auto& channel : p.unit_of_byte) channel.fill(0.5f);
    EXPECT_NO_THROW(bytes_of(radiance_of(every_byte(), p), p));
}

TEST(RadianceOfBytes, KnowsExposure)
{
    Photometry p = srgb_photometry();
    p.reference = {0.01, 2, 0, 0};
    cv::Mat const grey(1, 1, CV_8UC3, cv::Scalar::all(128));
    float const once = radiance_of(grey, p, p.reference).at<cv::Vec3f>(0)[0];
    EXPECT_NEAR(radiance_of(grey, p, {0.02, 2, 0, 0}).at<cv::Vec3f>(0)[0], once / 2, 1e-6);
    EXPECT_NEAR(radiance_of(grey, p, {}).at<cv::Vec3f>(0)[0], once, 1e-6) << "unknown exposures change nothing";
}

TEST(RadianceOfBytes, KnowsWhiteBalance)
{
    Photometry p = srgb_photometry();
    p.reference = {0.01, 1, 1.5, 2};
    cv::Mat const rgb = every_byte();
    Exposure const bluer{0.01, 1, 1.5, 4}, unknown{0.01, 1, 0, 4};
    cv::Mat const seen = radiance_of(rgb, p, bluer), before = radiance_of(rgb, p, p.reference);
    for (int i = 0; i < 256; ++i) {
        cv::Vec3f const a = seen.at<cv::Vec3f>(i / 16, i % 16), b = before.at<cv::Vec3f>(i / 16, i % 16);
        EXPECT_EQ(a[0], b[0]);
        EXPECT_EQ(a[1], b[1]);
        EXPECT_FLOAT_EQ(a[2], b[2] / 2);
    }
    EXPECT_TRUE(equal(radiance_of(rgb, p, unknown), seen)) << "what is not said is unchanged";
    p.colour = {1.2f, -0.1f, -0.1f, -0.05f, 1.1f, -0.05f, 0, -0.2f, 1.2f};
    EXPECT_TRUE(equal(bytes_of(radiance_of(rgb, p, bluer), p, bluer), rgb));
}

TEST(RadianceOfBytes, SaysWhatIsClipped)
{
    cv::Mat rgb(1, 3, CV_8UC3, cv::Scalar::all(100));
    rgb.at<cv::Vec3b>(1) = {100, 255, 100};
    rgb.at<cv::Vec3b>(2) = {100, 0, 100};
    EXPECT_EQ(is_clipped(rgb).at<uchar>(0), 0);
    EXPECT_EQ(is_clipped(rgb).at<uchar>(1), 255);
    EXPECT_EQ(is_clipped(rgb).at<uchar>(2), 255);
}

Frame frame(PixelFormat format, cv::Mat first, cv::Mat second = {})
{
    Frame f;
    f.format = format;
    f.size_px = {16, 16};
    f.planes = {std::move(first), std::move(second)};
    return f;
}

TEST(Frames, OfAllFormatsHaveColour)
{
    cv::Mat const red(16, 16, CV_8UC3, cv::Scalar(200, 60, 60));
    auto const near_red = [](Frame const& f, int tolerance) {
        cv::Vec3b const v = rgb_of(f).at<cv::Vec3b>(8, 8);
        EXPECT_NEAR(v[0], 200, tolerance) << name_of(f.format);
        EXPECT_NEAR(v[1], 60, tolerance) << name_of(f.format);
        EXPECT_NEAR(v[2], 60, tolerance) << name_of(f.format);
        EXPECT_EQ(gray_of(f).type(), CV_8UC1);
        EXPECT_EQ(gray_of(f).size(), cv::Size(16, 16));
    };
    near_red(frame(PixelFormat::rgb8, red), 0);
    cv::Mat bgr;
    cv::cvtColor(red, bgr, cv::COLOR_RGB2BGR);
    near_red(frame(PixelFormat::bgr8, bgr), 0);
    // BT.601, limited range: Y = 16 + 65.5 r + 128.6 g + 25 b, ...
    cv::Mat const y(16, 16, CV_8UC1, cv::Scalar(104)), uv(8, 8, CV_8UC2, cv::Scalar(107, 189));
    near_red(frame(PixelFormat::nv12, y, uv), 3);
    cv::Mat yuyv(16, 16, CV_8UC2);
    for (int i = 0; i < 256; ++i) yuyv.at<cv::Vec2b>(i / 16, i % 16) = {104, uchar(i % 2 == 0 ? 107 : 189)};
    near_red(frame(PixelFormat::yuyv, yuyv), 3);
    std::vector<uchar> jpeg;
    cv::imencode(".jpg", bgr, jpeg);
    near_red(frame(PixelFormat::mjpeg, cv::Mat(jpeg, true).reshape(1, 1)), 4);
}

TEST(Frames, ThatAreTruncatedAreRefused)
{
    cv::Mat const nothing(1, 20, CV_8UC1, cv::Scalar(7));
    EXPECT_THROW(rgb_of(frame(PixelFormat::mjpeg, nothing)), gi::InputError);
    std::vector<uchar> jpeg;
    cv::imencode(".jpg", cv::Mat(8, 8, CV_8UC3, cv::Scalar::all(9)), jpeg);
    EXPECT_THROW(gray_of(frame(PixelFormat::mjpeg, cv::Mat(jpeg, true).reshape(1, 1))), gi::InputError)
        << "another size";
}

} // namespace
} // namespace ar::test
