// Frames of 16 bits and of linear radiance keep their bits.

#include "ar/composite/composite.h"
#include "gi/core/error.h"
#include "tests/ar_composite/test_pictures.h"

#include <gtest/gtest.h>

namespace ar::test {
namespace {

cv::Mat deep_frame(cv::Size size, int depth)
{
    cv::Mat picture(size, CV_MAKETYPE(depth, 3));
    cv::RNG random{11};
    if (depth == CV_32F)
        random.fill(picture, cv::RNG::UNIFORM, -0.1, 4);
    else
        random.fill(picture, cv::RNG::UNIFORM, 0, 65536);
    return picture;
}

TEST(DeepFrames, OfNothingVirtualKeepTheirBits)
{
    cv::Size const size(97, 61);
    Photometry odd = srgb_photometry();
    for (auto& channel : odd.unit_of_byte)
        for (float& u : channel) u = 0.01f + 0.9f * u * u;
    odd.vignetting = {-0.3, 0, 0};
    for (Photometry const& p : {srgb_photometry(), odd})
        for (int const depth : {CV_16U, CV_32F}) {
            cv::Mat const camera = deep_frame(size, depth);
            cv::Mat out;
            CompositeSettings settings;
            settings.noise.constant = {1, 1, 1};
            CompositeCounts const counts = Compositor{p, settings}(camera, unchanged_pair(size), {}, out);
            EXPECT_TRUE(equal(out, camera));
            EXPECT_EQ(counts.copied, std::size_t(size.area()));
            if (p.vignetting[0] != 0) continue; // codes of the flat part differ by less than what follows
            RenderedPair nearly = unchanged_pair(size);
            nearly.with *= 1 + 1e-7;
            Compositor{p}(camera, nearly, {}, out);
            EXPECT_LT(cv::norm(out, camera, cv::NORM_INF), depth == CV_16U ? 0.5 : 1e-5);
        }
}

TEST(DeepFrames, ThatAreBytesGiveTheBytesComposite)
{
    cv::Size const size(120, 80);
    cv::Mat const bytes = camera_frame(size);
    cv::Mat wide, out8, out16;
    bytes.convertTo(wide, CV_16U, 257);
    RenderedPair const pair{random_radiance(size, 1), random_radiance(size, 2), cv::Mat::zeros(size, CV_32FC1)};
    Compositor composite(srgb_photometry());
    composite(bytes, pair, {}, out8);
    composite(wide, pair, {}, out16);
    out16.convertTo(out16, CV_32F, 1 / 257.0);
    out8.convertTo(out8, CV_32F);
    EXPECT_LE(cv::norm(out8, out16, cv::NORM_INF), 0.502) << "half a byte, as rounding makes";
    EXPECT_GT(cv::norm(out8, out16, cv::NORM_L1), 100) << "16 bits say more";
}

TEST(DeepFrames, OfRadianceAreDebevecsEquationWithoutLimits)
{
    cv::Size const size(64, 48);
    cv::Mat const camera = deep_frame(size, CV_32F);
    RenderedPair pair{random_radiance(size, 1), random_radiance(size, 2), random_radiance(size, 3)};
    cv::extractChannel(pair.coverage, pair.coverage, 0);
    Photometry p = srgb_photometry();
    p.radiance_per_unit = 20;
    p.vignetting = {-0.3, 0, 0}; // radiance has no fall-off
    cv::Mat out;
    Compositor{p}(camera, pair, {.time_s = 0.1}, out);
    ASSERT_EQ(out.type(), CV_32FC3);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            for (int c = 0; c < 3; ++c) {
                float const u = camera.at<cv::Vec3f>(y, x)[c], a = pair.coverage.at<float>(y, x);
                float const expected =
                    pair.with.at<cv::Vec3f>(y, x)[c] + (1 - a) * (u - pair.without.at<cv::Vec3f>(y, x)[c]);
                EXPECT_NEAR(out.at<cv::Vec3f>(y, x)[c], std::max(expected, std::min(u, 0.0f)), 1e-5f);
            }
}

TEST(DeepFrames, ThatAreNotFiniteKeepTheCamerasPixel)
{
    cv::Mat camera(1, 2, CV_32FC3, cv::Scalar(0.5, 0.5, 0.5));
    camera.at<cv::Vec3f>(0, 0)[1] = std::numeric_limits<float>::quiet_NaN();
    cv::Mat const one(1, 2, CV_32FC3, cv::Scalar(1, 1, 1)), two(1, 2, CV_32FC3, cv::Scalar(2, 2, 2));
    cv::Mat out;
    CompositeCounts const counts =
        Compositor{srgb_photometry()}(camera, {two, one, cv::Mat::zeros(1, 2, CV_32FC1)}, {}, out);
    EXPECT_EQ(counts.not_finite, 1u);
    EXPECT_EQ(out.at<cv::Vec3f>(0, 0)[0], 0.5f);
    EXPECT_EQ(out.at<cv::Vec3f>(0, 1)[0], 1.5f);
}

TEST(DeepFrames, OfOtherTypesAreRefused)
{
    cv::Mat out;
    EXPECT_THROW(Compositor{srgb_photometry()}(cv::Mat(4, 4, CV_64FC3), unchanged_pair({4, 4}), {}, out),
                 gi::InputError);
}

TEST(DeepResponse, FindsTheNearestOf65536Codes)
{
    std::array<float, 256> flat = srgb_photometry().unit_of_byte[0];
    for (std::size_t b = 100; b < 120; ++b) flat[b] = flat[100];
    for (auto const& curve : {srgb_photometry().unit_of_byte[0], flat}) {
        DeepResponse const r(curve);
        for (int code = 0; code < 65536; code += 7) {
            auto const c = std::uint16_t(code);
            EXPECT_EQ(r.code_near(r.unit(c), c), c);
            EXPECT_EQ(r.unit(r.code(r.unit(c))), r.unit(c));
        }
        EXPECT_EQ(r.code(-1), 0);
        EXPECT_EQ(r.code(2), 65535);
        EXPECT_EQ(r.code(std::numeric_limits<float>::quiet_NaN()), 0);
        for (std::size_t b = 0; b < 256; ++b) EXPECT_FLOAT_EQ(r.unit(std::uint16_t(257 * b)), curve[b]);
    }
}

} // namespace
} // namespace ar::test
