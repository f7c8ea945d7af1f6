#include "ar/composite/upsample.h"

#include "ar/composite/composite.h"
#include "gi/core/error.h"
#include "tests/ar_composite/test_pictures.h"

#include <cmath>
#include <gtest/gtest.h>
#include <iostream>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

/// A floor and a wall that meet along a slanted line, a chequered texture on both,
/// a soft shadow on the floor alone.
struct Scene {
    RenderedPair pair;
    SurfaceGuides guides;
};

Scene scene(cv::Size size)
{
    Scene s{{cv::Mat(size, CV_32FC3), cv::Mat(size, CV_32FC3), cv::Mat::zeros(size, CV_32FC1)},
            {cv::Mat(size, CV_32FC3), cv::Mat(size, CV_32FC1), cv::Mat(size, CV_32FC3)}};
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            float const u = (float(x) + 0.5f) / float(size.width), v = (float(y) + 0.5f) / float(size.height);
            bool const floor = v > 0.4f + 0.3f * u;
            bool const dark = (int(u * 40) + int(v * 30)) % 2 == 0;
            float const albedo = dark ? 0.2f : 0.8f;
            float const d2 = (u - 0.5f) * (u - 0.5f) + (v - 0.6f) * (v - 0.6f);
            float const light = floor ? 1 - 0.6f * std::exp(-d2 / 0.03f) : 0.5f;
            s.pair.without.at<cv::Vec3f>(y, x) = cv::Vec3f::all(albedo * (floor ? 1.0f : 0.5f));
            s.pair.with.at<cv::Vec3f>(y, x) = cv::Vec3f::all(albedo * light);
            s.guides.normal.at<cv::Vec3f>(y, x) = floor ? cv::Vec3f(0, 1, 0) : cv::Vec3f(0, 0, -1);
            s.guides.depth.at<float>(y, x) = floor ? 2 - v : 1.6f;
            s.guides.albedo.at<cv::Vec3f>(y, x) = cv::Vec3f::all(albedo);
        }
    return s;
}

double rms(cv::Mat const& a, cv::Mat const& b) { return cv::norm(a, b) / std::sqrt(3.0 * double(a.total())); }

TEST(Upsampling, FollowsTheSurfaces)
{
    cv::Size const full(240, 180), half(120, 90);
    Scene const truth = scene(full), low = scene(half);
    DirectlySeen const nothing{cv::Mat::zeros(full, CV_32FC3), cv::Mat::zeros(full, CV_32FC1)};
    UpsampleCounts counts;
    RenderedPair const guided =
        upsampled(low.pair, low.guides, nothing, truth.guides, {}, truth.pair.without, &counts);
    RenderedPair const unguided = upsampled(low.pair, {}, nothing, {}, {}, truth.pair.without);
    cv::Mat change = low.pair.with - low.pair.without, bilinear;
    cv::resize(change, bilinear, full, 0, 0, cv::INTER_LINEAR);
    cv::Mat const wanted = truth.pair.with - truth.pair.without;
    double const by_guides = rms(guided.with - guided.without, wanted), by_size = rms(bilinear, wanted);
    std::cout << "error of the change at half resolution: bilinear " << by_size << ", without guides "
              << rms(unguided.with - unguided.without, wanted) << ", with guides " << by_guides << "; "
              << counts.without_guide << " pixels without a like neighbour\n";
    EXPECT_LT(by_guides, 0.15 * by_size);
    EXPECT_LT(counts.without_guide, 240u);
    EXPECT_EQ(counts.no_sample, 0u);
}

TEST(Upsampling, KeepsBytesWhereNothingChanges)
{
    cv::Size const full(64, 48), half(32, 24);
    Scene low = scene(half), truth = scene(full);
    low.pair.with = low.pair.without.clone();
    low.pair.with({0, 0, 10, 10}) *= 0.5; // but in one corner
    for (auto const& [guides, from] : {std::pair{&low.guides, 14}, {&truth.guides, 28}})
        for (cv::Mat const& guide : {guides->normal, guides->depth, guides->albedo})
            guide.colRange(from, guide.cols).setTo(cv::Scalar::all(std::nan(""))); // undefined there
    DirectlySeen const nothing{cv::Mat::zeros(full, CV_32FC3), cv::Mat::zeros(full, CV_32FC1)};
    RenderedPair const pair = upsampled(low.pair, low.guides, nothing, truth.guides);
    cv::Mat const camera = camera_frame(full);
    cv::Mat out;
    CompositeCounts const counts = Compositor(srgb_photometry())(camera, pair, {}, out);
    EXPECT_GE(counts.copied, std::size_t(64 * 48 - 24 * 24));
    EXPECT_EQ(counts.not_finite, 0u);
    EXPECT_TRUE(equal(out.colRange(24, 64), camera.colRange(24, 64)));
}

TEST(Upsampling, LeavesBordersOfObjectsSharp)
{
    cv::Size const full(64, 48), half(32, 24);
    Scene const truth = scene(full);
    Scene low = scene(half);
    // The object is at the left at both resolutions, and very bright:
    // its low-resolution pixels must not affect the place.
    DirectlySeen seen{cv::Mat::zeros(full, CV_32FC3), cv::Mat::zeros(full, CV_32FC1)};
    seen.coverage.colRange(0, 31) = 1;
    seen.coverage.col(31) = 0.25;
    seen.radiance.colRange(0, 31) = cv::Scalar::all(50);
    seen.radiance.col(31) = cv::Scalar::all(12.5);
    low.pair.coverage.colRange(0, 16) = 1;
    low.pair.with.colRange(0, 16) = cv::Scalar::all(50);
    UpsampleCounts counts;
    RenderedPair const pair = upsampled(low.pair, low.guides, seen, truth.guides, {}, truth.pair.without, &counts);
    for (int y = 0; y < 48; ++y) {
        EXPECT_EQ(pair.with.at<cv::Vec3f>(y, 20)[0], 50);
        EXPECT_LE(pair.with.at<cv::Vec3f>(y, 32)[0], 1) << "no light of the object beside it";
        EXPECT_NEAR(pair.with.at<cv::Vec3f>(y, 31)[0], 12.5, 0.75);
        EXPECT_EQ(pair.coverage.at<float>(y, 31), 0.25f);
    }
    EXPECT_EQ(counts.no_sample, std::size_t(48 * 29)) << "only within the object";
}

TEST(Upsampling, RefusesGuidesOfOneResolution)
{
    cv::Size const full(64, 48);
    Scene const truth = scene(full), low = scene({32, 24});
    DirectlySeen const nothing{cv::Mat::zeros(full, CV_32FC3), cv::Mat::zeros(full, CV_32FC1)};
    EXPECT_THROW(upsampled(low.pair, {}, nothing, truth.guides), gi::InputError);
    EXPECT_THROW(upsampled(low.pair, low.guides, nothing, {}), gi::InputError);
    EXPECT_THROW(upsampled(low.pair, truth.guides, nothing, truth.guides), gi::InputError);
}

} // namespace
} // namespace ar::test
