#include "ar/composite/composite.h"

#include "gi/core/error.h"
#include "tests/ar_composite/test_pictures.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace ar::test {
namespace {

/// A response with plateaus, vignetting, colours: what calibration may find.
Photometry odd_photometry()
{
    Photometry p = srgb_photometry();
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t b = 0; b < 256; ++b) {
            float const t = float(b / 2 * 2) / 255; // pairs of bytes mean the same
            p.unit_of_byte[c][b] = 0.002f + 1.3f * std::pow(t, 1.8f + 0.2f * float(c));
        }
    p.vignetting = {-0.3, 0.05, -0.01};
    p.colour = {1.2f, -0.1f, -0.1f, -0.05f, 1.1f, -0.05f, 0, -0.2f, 1.2f};
    p.radiance_per_unit = 37.5;
    p.reference = {0.01, 1, 0, 0};
    return p;
}

TEST(Composite, OfNothingIsTheCameraFrameBitForBit)
{
    cv::Size const size(97, 61);
    cv::Mat const camera = camera_frame(size);
    for (Photometry const& p : {srgb_photometry(), odd_photometry()})
        for (Blend const blend : {Blend::difference, Blend::ratio}) {
            CompositeSettings settings;
            settings.blend = blend;
            settings.noise.constant = {1, 1, 1};
            Compositor composite(p, settings);
            cv::Mat out;
            CompositeCounts const counts = composite(camera, unchanged_pair(size), {0.03, 1, 0, 0}, out);
            EXPECT_TRUE(equal(out, camera));
            EXPECT_EQ(counts.copied, size.area());
            EXPECT_EQ(counts.covered + counts.clipped + counts.negative + counts.not_finite, 0u);
        }
}

TEST(Composite, ThatChangesNextToNothingKeepsTheBytes)
{
    cv::Size const size(256, 40);
    cv::Mat const camera = camera_frame(size);
    RenderedPair pair = unchanged_pair(size);
    pair.with *= 1 + 1e-6;
    cv::Mat out;
    CompositeCounts const counts = Compositor(odd_photometry())(camera, pair, {}, out);
    EXPECT_TRUE(equal(out, camera)) << "bytes with equal units must not be exchanged";
    EXPECT_LT(counts.copied, std::size_t(size.area()) / 10);
}

TEST(Composite, FadesLightShadowsAndCoverageAlike)
{
    cv::Size const size(120, 80);
    cv::Mat const camera = camera_frame(size) * 0.99;
    RenderedPair pair{random_radiance(size, 1, 0, 1), random_radiance(size, 2, 0, 1), cv::Mat(size, CV_32FC1)};
    cv::randu(pair.coverage, 0, 1);
    pair.coverage.rowRange(0, 20) = 0; // shadows and light alone
    pair.without.rowRange(0, 5).copyTo(pair.with.rowRange(0, 5));
    Photometry const p = srgb_photometry();
    CompositeSettings settings;
    settings.noise.constant = {1e-4f, 1e-4f, 1e-4f};
    cv::Mat out, full;
    Compositor(p, settings)(camera, faded(pair, 0), {}, out);
    EXPECT_TRUE(equal(out, camera)) << "bit for bit";
    Compositor(p, settings)(camera, faded(pair, 0.4), {}, out);
    EXPECT_TRUE(equal(out.rowRange(0, 5), camera.rowRange(0, 5))) << "where nothing changes";
    Compositor quiet{p};
    quiet(camera, pair, {}, full);
    quiet(camera, faded(pair, 0.4), {}, out);
    cv::Mat const from = radiance_of(camera, p), to = radiance_of(full, p), is = radiance_of(out, p);
    cv::Mat const inside = (full > 0) & (full < 255); // not clamped
    cv::Mat off = cv::abs(is - (0.6 * from + 0.4 * to)), step = 0.006 + 0.01 * to;
    std::size_t wrong = 0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            for (int c = 0; c < 3; ++c)
                wrong +=
                    inside.at<cv::Vec3b>(y, x)[c] > 0 && off.at<cv::Vec3f>(y, x)[c] > step.at<cv::Vec3f>(y, x)[c];
    EXPECT_EQ(wrong, 0u);
}

TEST(Composite, IsDebevecsEquation)
{
    cv::Size const size(120, 80);
    cv::Mat const camera = camera_frame(size) * 0.99; // no byte of 255
    RenderedPair pair{random_radiance(size, 1, 0, 40), random_radiance(size, 2, 0, 20), cv::Mat(size, CV_32FC1)};
    cv::randu(pair.coverage, 0, 1);
    pair.coverage.rowRange(0, 10) = 0;
    pair.coverage.rowRange(10, 20) = 1;
    Exposure const exposure{0.015, 1, 0, 0};
    for (Photometry p : {srgb_photometry(), odd_photometry()}) {
        p.radiance_per_unit = 37.5;
        cv::Mat out;
        CompositeCounts const counts = Compositor(p)(camera, pair, exposure, out);
        cv::Mat const seen = radiance_of(camera, p, exposure);
        cv::Mat expected(size, CV_32FC3);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x) {
                float const a = pair.coverage.at<float>(y, x);
                cv::Vec3f const w = pair.with.at<cv::Vec3f>(y, x), n = pair.without.at<cv::Vec3f>(y, x);
                expected.at<cv::Vec3f>(y, x) = a * w + (1 - a) * (seen.at<cv::Vec3f>(y, x) + w - n);
            }
        cv::Mat const bytes = bytes_of(expected, p, exposure);
        std::size_t wrong = 0;
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                for (int c = 0; c < 3; ++c) {
                    auto const is = out.at<cv::Vec3b>(y, x)[c], wanted = bytes.at<cv::Vec3b>(y, x)[c];
                    auto const& unit = p.unit_of_byte[std::size_t(c)];
                    wrong += is != wanted && unit[is] != unit[wanted];
                }
        EXPECT_LE(wrong, 5u) << "but for rounding at the middle of two bytes";
        EXPECT_GT(counts.negative, 0u);
        EXPECT_EQ(counts.covered, std::size_t(size.area() - 10 * 120));
    }
}

TEST(Composite, OfAntialiasedBordersIsExact)
{
    // Truth: half a pixel of an object of 0.6, half a place whose light fell from 0.4 to 0.3;
    // the model has 0.5 -> 0.4.
    Photometry const p = srgb_photometry();
    cv::Mat const camera(1, 1, CV_8UC3, cv::Scalar::all(170));
    float const seen = p.unit_of_byte[0][170];
    RenderedPair const pair{cv::Mat(1, 1, CV_32FC3, cv::Scalar::all(0.5 * 0.6 + 0.5 * 0.4)),
                            cv::Mat(1, 1, CV_32FC3, cv::Scalar::all(0.5)),
                            cv::Mat(1, 1, CV_32FC1, cv::Scalar(0.5))};
    cv::Mat out;
    Compositor composite(p);
    composite(camera, pair, {}, out);
    EXPECT_EQ(out.at<cv::Vec3b>(0)[1], composite.response(1).byte(0.5f * 0.6f + 0.5f * (seen - 0.1f)));
}

TEST(Composite, FallsBackToTheCameraWhereRenderingFailed)
{
    float const nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    cv::Size const size(6, 1);
    cv::Mat const camera = camera_frame(size);
    RenderedPair pair = unchanged_pair(size);
    pair.with.at<cv::Vec3f>(0)[1] = nan;
    pair.without.at<cv::Vec3f>(1)[2] = inf;
    pair.coverage.at<float>(2) = nan;
    pair.coverage.at<float>(3) = -2; // nothing
    pair.coverage.at<float>(4) = 7;  // all
    pair.without.at<cv::Vec3f>(4)[0] = nan;
    cv::Mat out;
    CompositeCounts const counts = Compositor(srgb_photometry())(camera, pair, {}, out);
    EXPECT_EQ(counts.not_finite, 3u);
    EXPECT_EQ(counts.coverage_range, 2u);
    EXPECT_TRUE(equal(out.colRange(0, 4), camera.colRange(0, 4)));
    EXPECT_TRUE(equal(out.col(4), bytes_of(pair.with.col(4), srgb_photometry())))
        << "what is behind does not matter";
}

TEST(Composite, KnowsThatClippedBytesHideLight)
{
    // The place has 2.5 units, the byte says 1; a shadow of half should leave 1.25 (255), a quarter of it 0.625.
    Photometry const p = srgb_photometry();
    cv::Mat const camera(1, 1, CV_8UC3, cv::Scalar::all(255));
    auto const shown = [&](ClippedBytes clipped, float with, float without) {
        CompositeSettings settings;
        settings.clipped = clipped;
        RenderedPair const pair{cv::Mat(1, 1, CV_32FC3, cv::Scalar::all(with)),
                                cv::Mat(1, 1, CV_32FC3, cv::Scalar::all(without)), cv::Mat::zeros(1, 1, CV_32FC1)};
        cv::Mat out;
        EXPECT_EQ(Compositor(p, settings)(camera, pair, {}, out).clipped, 1u);
        return p.unit_of_byte[0][out.at<cv::Vec3b>(0)[0]];
    };
    EXPECT_NEAR(shown(ClippedBytes::model, 0.625f, 2.5f), 0.625, 0.003) << "the truth";
    EXPECT_NEAR(shown(ClippedBytes::ratio, 0.625f, 2.5f), 0.25, 0.003);
    EXPECT_EQ(shown(ClippedBytes::as_measured, 0.625f, 2.5f), 0);
    EXPECT_NEAR(shown(ClippedBytes::model, 0.4f, 0.8f), 0.5, 0.003) << "a model that is too dark: the ratio";
    EXPECT_EQ(shown(ClippedBytes::model, 3, 2.5f), 1) << "brighter stays clipped";
}

TEST(Composite, ByRatioForgivesErrorsOfAlbedo)
{
    // The proxy's albedo is half of the truth; a shadow takes 60 % of the light.
    Photometry const p = srgb_photometry();
    cv::Mat const camera(1, 2, CV_8UC3, cv::Scalar::all(200));
    float const seen = p.unit_of_byte[0][200];
    RenderedPair pair{cv::Mat(1, 2, CV_32FC3, cv::Scalar::all(0.4 * 0.5 * seen)),
                      cv::Mat(1, 2, CV_32FC3, cv::Scalar::all(0.5 * seen)), cv::Mat::zeros(1, 2, CV_32FC1)};
    pair.without.at<cv::Vec3f>(1) = {0, 0, 0}; // no light to multiply: the difference
    CompositeSettings settings;
    settings.blend = Blend::ratio;
    cv::Mat ratio, difference;
    EXPECT_EQ(Compositor(p, settings)(camera, pair, {}, ratio).ratio_limited, 3u);
    Compositor{p}(camera, pair, {}, difference);
    EXPECT_NEAR(p.unit_of_byte[0][ratio.at<cv::Vec3b>(0)[0]], 0.4 * seen, 0.004);
    EXPECT_NEAR(p.unit_of_byte[0][difference.at<cv::Vec3b>(0)[0]], 0.7 * seen, 0.004);
    EXPECT_EQ(ratio.at<cv::Vec3b>(1), difference.at<cv::Vec3b>(1));
}

TEST(Composite, MayWriteIntoTheFrame)
{
    cv::Size const size(33, 21);
    cv::Mat camera = camera_frame(size), out;
    RenderedPair pair = unchanged_pair(size);
    pair.with *= 0.5;
    Compositor composite(srgb_photometry());
    composite(camera, pair, {}, out);
    composite(camera, pair, {}, camera);
    EXPECT_TRUE(equal(out, camera));
}

TEST(Composite, RefusesWhatDoesNotFit)
{
    Compositor composite(srgb_photometry());
    cv::Mat out;
    RenderedPair pair = unchanged_pair({8, 6});
    EXPECT_THROW(composite(camera_frame({9, 6}), pair, {}, out), gi::InputError);
    EXPECT_THROW(composite(cv::Mat(6, 8, CV_8UC1), pair, {}, out), gi::InputError);
    pair.coverage = cv::Mat();
    EXPECT_THROW(composite(camera_frame({8, 6}), pair, {}, out), gi::InputError);
    Photometry p = srgb_photometry();
    p.colour = cv::Matx33f::zeros();
    EXPECT_THROW(Compositor{p}, gi::InputError);
}

TEST(ResponseTables, FindTheNearestByte)
{
    for (Photometry const& p : {srgb_photometry(), odd_photometry()}) {
        ResponseTable const table(p.unit_of_byte[0]);
        cv::RNG random(5);
        for (int i = 0; i < 20000; ++i) {
            float const u = random.uniform(-0.1f, 1.5f);
            float best = std::numeric_limits<float>::infinity();
            for (float const unit : p.unit_of_byte[0]) best = std::min(best, std::abs(unit - u));
            EXPECT_LE(std::abs(p.unit_of_byte[0][table.byte(u)] - u), best + 1e-7f) << u;
        }
        for (int b = 0; b < 256; ++b) EXPECT_EQ(table.byte_near(table.unit(uchar(b)), uchar(b)), b);
        EXPECT_EQ(table.byte(std::numeric_limits<float>::infinity()), 255);
        EXPECT_EQ(table.byte(std::numeric_limits<float>::quiet_NaN()), 0);
    }
    std::array<float, 256> flat;
    flat.fill(0.5f);
    EXPECT_EQ(ResponseTable(flat).byte(0.4f), 0);
    EXPECT_EQ(ResponseTable(flat).byte_near(0.5f, 77), 77);
}

} // namespace
} // namespace ar::test
