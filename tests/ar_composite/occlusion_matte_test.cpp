#include "ar/composite/occlusion_matte.h"

#include "ar/composite/composite.h"
#include "gi/core/error.h"
#include "tests/ar_composite/test_pictures.h"

#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

cv::Size const kSize(200, 150);

/// How much of each pixel a rounded real object covers, smooth over a pixel.
cv::Mat occluder(double shift_x, double shift_y)
{
    cv::Mat alpha(kSize, CV_32FC1);
    for (int y = 0; y < kSize.height; ++y)
        for (int x = 0; x < kSize.width; ++x) {
            double const dx = (x - 95 - shift_x) / 34, dy = (y - 80 - shift_y) / 45;
            double const d = (std::pow(std::pow(std::abs(dx), 3) + std::pow(std::abs(dy), 3), 1.0 / 3) - 1) * 36;
            alpha.at<float>(y, x) = float(std::clamp(0.5 - d, 0.0, 1.0));
        }
    return alpha;
}

/// Radiance of a textured, noisy frame: a thing before a wall.
cv::Mat camera_radiance(cv::Vec3f thing, cv::Vec3f wall)
{
    cv::Mat const alpha = occluder(0, 0);
    cv::Mat picture(kSize, CV_32FC3), noise(kSize, CV_32FC3);
    cv::RNG random{3};
    random.fill(noise, cv::RNG::NORMAL, 0, 0.01);
    for (int y = 0; y < kSize.height; ++y)
        for (int x = 0; x < kSize.width; ++x) {
            float const a = alpha.at<float>(y, x);
            float const texture = 1 + 0.2f * float(std::sin(0.3 * x) * std::sin(0.4 * y));
            picture.at<cv::Vec3f>(y, x) = (a * thing + (1 - a) * wall) * texture + noise.at<cv::Vec3f>(y, x);
        }
    return picture;
}

/// A virtual disc behind the thing.
cv::Mat object()
{
    cv::Mat disc = cv::Mat::zeros(kSize, CV_32FC1);
    cv::circle(disc, {120, 70}, 65, cv::Scalar(1), cv::FILLED);
    return disc;
}

double error(cv::Mat const& a, cv::Mat const& b) { return cv::norm(a, b, cv::NORM_L1); }

TEST(OcclusionMatte, HalvesTheErrorOfProxiesThatAreOff)
{
    cv::Mat const camera = camera_radiance({0.5f, 0.2f, 0.12f}, {0.25f, 0.3f, 0.4f}), disc = object();
    cv::Mat const truth = disc.mul(1 - occluder(0, 0));
    for (auto const& [dx, dy] : {std::pair{2.0, 0.0}, {-3.0, 0.0}, {2.0, 2.0}, {-1.5, 2.5}, {0.0, 0.0}}) {
        cv::Mat const coverage = disc.mul(1 - occluder(dx, dy));
        MatteCounts counts;
        cv::Mat const refined = refined_coverage(coverage, disc, camera, {}, &counts);
        double const before = error(coverage, truth), after = error(refined, truth);
        std::cout << "proxy off by (" << dx << ", " << dy << ") px: sum of alpha's error " << before << " -> "
                  << after << ", " << counts.refined << " of " << counts.band << " pixels of the band changed\n";
        if (dx != 0 || dy != 0)
            EXPECT_LT(after, 0.5 * before);
        else
            EXPECT_LT(after, 40) << "of 200 pixels along the border: right proxies are not spoilt";
        cv::Mat const outside = (disc == 0) & (refined != coverage);
        EXPECT_EQ(cv::countNonZero(outside), 0) << "borders against what is behind are exact";
        if (dx == -3) {
            // The object, radiance 0.1 0.5 0.1, in the frame: before and after.
            DirectlySeen all{cv::Mat(kSize, CV_32FC3), disc};
            DirectlySeen seen{cv::Mat(kSize, CV_32FC3), coverage};
            for (int y = 0; y < kSize.height; ++y)
                for (int x = 0; x < kSize.width; ++x) {
                    all.radiance.at<cv::Vec3f>(y, x) = disc.at<float>(y, x) * cv::Vec3f(0.1f, 0.5f, 0.1f);
                    seen.radiance.at<cv::Vec3f>(y, x) = coverage.at<float>(y, x) * cv::Vec3f(0.1f, 0.5f, 0.1f);
                }
            RenderedPair pair{cv::Mat(kSize, CV_32FC3), cv::Mat(kSize, CV_32FC3, cv::Scalar::all(0.3)), coverage};
            pair.with.forEach<cv::Vec3f>([&](cv::Vec3f& v, int const* at) {
                v = seen.radiance.at<cv::Vec3f>(at[0], at[1]) +
                    (1 - coverage.at<float>(at[0], at[1])) * cv::Vec3f(0.3f, 0.3f, 0.3f);
            });
            RenderedPair const better = with_coverage(pair, refined, seen, all);
            Photometry const p = srgb_photometry();
            cv::Mat const frame = bytes_of(camera, p);
            cv::Mat first, second, wanted(kSize, CV_32FC3);
            Compositor composite(p);
            composite(frame, pair, {}, first);
            composite(frame, better, {}, second);
            wanted.forEach<cv::Vec3f>([&](cv::Vec3f& v, int const* at) {
                float const a = truth.at<float>(at[0], at[1]);
                v = a * cv::Vec3f(0.1f, 0.5f, 0.1f) + (1 - a) * camera.at<cv::Vec3f>(at[0], at[1]);
            });
            cv::Mat const right = bytes_of(wanted, p);
            std::cout << "composite, error of all bytes: " << error(first, right) << " -> " << error(second, right)
                      << "\n";
            EXPECT_LT(error(second, right), 0.5 * error(first, right));
            if (char const* const folder = std::getenv("LIGHTWELL_TEST_PICTURES")) {
                cv::Mat all_three;
                cv::hconcat(std::vector<cv::Mat>{first, second, right}, all_three);
                cv::cvtColor(all_three, all_three, cv::COLOR_RGB2BGR);
                cv::resize(all_three, all_three, {}, 2, 2, cv::INTER_NEAREST);
                cv::imwrite(std::string(folder) + "/occlusion_matte.png", all_three);
            }
        }
    }
}

TEST(OcclusionMatte, KeepsTheProxyWhereColoursSayNothing)
{
    cv::Mat const camera = camera_radiance({0.3f, 0.3f, 0.3f}, {0.3f, 0.3f, 0.3f}), disc = object();
    cv::Mat const coverage = disc.mul(1 - occluder(2, 0));
    MatteCounts counts;
    cv::Mat const refined = refined_coverage(coverage, disc, camera, {}, &counts);
    EXPECT_TRUE(equal(refined, coverage));
    EXPECT_GT(counts.band, 500u);
    EXPECT_EQ(counts.refined, 0u);
}

TEST(OcclusionMatte, OfNothingHiddenChangesNothing)
{
    MatteCounts counts;
    cv::Mat const camera = camera_radiance({1, 0, 0}, {0, 1, 0}), disc = object();
    EXPECT_TRUE(equal(refined_coverage(disc, disc, camera, {}, &counts), disc));
    EXPECT_EQ(counts.band, 0u);
    EXPECT_THROW(refined_coverage(disc, disc, cv::Mat(), {}), gi::InputError);
    EXPECT_THROW(refined_coverage(disc, disc, camera, {.band_px = 8, .radius_px = 8}), gi::InputError);
}

} // namespace
} // namespace ar::test
