#include "ar/composite/temporal.h"

#include "gi/core/error.h"
#include "tests/ar_composite/test_pictures.h"

#include <cmath>
#include <gtest/gtest.h>
#include <iostream>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

cv::Size const kFrameSize(96, 72);
CameraModel const kCamera{LensModel::pinhole, {96, 72}, 90, 90, 47.5, 35.5, {}};

/// A shadow of `depth` on a place of 0.5, with noise of sigma 0.05 in the shadow; nothing in the left quarter.
RenderedPair noisy_shadow(int frame, float change = -0.2f)
{
    RenderedPair pair = unchanged_pair(kFrameSize);
    pair.without = cv::Scalar::all(0.5);
    pair.with = pair.without.clone();
    cv::Mat noise(kFrameSize, CV_32FC3);
    cv::RNG random{std::uint64_t(frame + 1)};
    random.fill(noise, cv::RNG::NORMAL, change, 0.05);
    cv::Mat const place = pair.with.colRange(24, 96);
    place += noise.colRange(24, 96);
    return pair;
}

cv::Rect const kShadow(36, 12, 50, 50); // away from its border

double variance_within(RenderedPair const& pair)
{
    cv::Mat const change = pair.with(kShadow) - pair.without(kShadow);
    cv::Scalar mean, deviation;
    cv::meanStdDev(change, mean, deviation);
    return deviation[0] * deviation[0];
}

double mean_within(RenderedPair const& pair) { return cv::mean(pair.with(kShadow) - pair.without(kShadow))[0]; }

TEST(TemporalFilter, TakesNoiseAwayAndFollowsChanges)
{
    cv::Mat const depth(kFrameSize, CV_32FC1, cv::Scalar(2));
    for (float const weight : {0.1f, 0.2f, 0.5f}) {
        TemporalFilter filter(kCamera, {.weight = weight});
        RenderedPair out;
        for (int i = 0; i < 60; ++i) out = filter(noisy_shadow(i), depth, {});
        double const left = variance_within(out) / variance_within(noisy_shadow(59)),
                     ideal = weight / (2 - weight);
        EXPECT_NEAR(mean_within(out), -0.2, 0.005) << "no bias";
        int lag = 0; // frames until 63 % of a step are there
        for (; lag < 50; ++lag)
            if (mean_within(filter(noisy_shadow(100 + lag, 0.1f), depth, {})) > -0.2 + 0.63 * 0.3) break;
        std::cout << "weight " << weight << ": " << left << " of the variance is left (" << ideal
                  << " without clipping), a step is followed in " << lag + 1 << " frames, "
                  << filter.counts().clipped << " values clipped at it\n";
        EXPECT_LT(left, 1.3 * ideal + 0.02);
        EXPECT_LE(lag, 2) << "steps of more than the noise are clipped to the new frame's range";
    }
    TemporalFilter unclipped(kCamera, {.weight = 0.2f, .gamma = std::numeric_limits<float>::infinity()});
    for (int i = 0; i < 40; ++i) unclipped(noisy_shadow(i), depth, {});
    int lag = 0;
    for (; lag < 50; ++lag)
        if (mean_within(unclipped(noisy_shadow(100 + lag, 0.1f), depth, {})) > -0.2 + 0.63 * 0.3) break;
    std::cout << "weight 0.2 without clipping: a step is followed in " << lag + 1 << " frames\n";
    EXPECT_EQ(lag + 1, 5);
}

/// A face whose pixels share their noise: all of it is brighter or darker from frame to frame.
TEST(TemporalFilter, KnowsAStillSceneFromAChangeOfLight)
{
    cv::Mat const depth(kFrameSize, CV_32FC1, cv::Scalar(2));
    TemporalFilter filter(kCamera, {.weight = 0.2f}), unknowing(kCamera, {.weight = 0.2f});
    auto const face = [](int frame, float light) {
        RenderedPair pair = unchanged_pair(kFrameSize);
        pair.with(kShadow) += cv::Scalar::all(light * (1 + (frame % 2 ? 0.15 : -0.15)));
        return pair;
    };
    std::vector<double> still, clipped;
    for (int i = 0; i < 40; ++i) {
        double const now =
            mean_within(filter(face(i, 0.2f), depth, {}, i > 0 ? SceneChange::none : SceneChange::unknown));
        double const other = mean_within(unknowing(face(i, 0.2f), depth, {}));
        if (i >= 24) {
            still.push_back(now);
            clipped.push_back(other);
        }
    }
    auto const range = [](std::vector<double> const& v) {
        auto const [low, high] = std::minmax_element(v.begin(), v.end());
        return (*high - *low) / *high;
    };
    std::cout << "a face that flickers by 15 %: " << 100 * range(still) << " % where it is known to be still, "
              << 100 * range(clipped) << " % where it is not\n";
    EXPECT_LT(range(still), 0.02);
    EXPECT_GT(range(clipped), 0.1);
    EXPECT_NEAR(still.back(), 0.2, 0.004);
    int lag = 0; // a lamp is switched on
    for (; lag < 50; ++lag)
        if (mean_within(filter(face(lag, 0.6f), depth, {}, lag > 0 ? SceneChange::none : SceneChange::unknown)) >
            0.45)
            break;
    EXPECT_LE(lag, 2);
}

/// Over a still scene, too, history is not looked up between pixels for ever.
TEST(TemporalFilter, KeepsTexturesWhileTheCameraMovesOverAStillScene)
{
    cv::Mat const depth(kFrameSize, CV_32FC1, cv::Scalar(2));
    TemporalFilter filter(kCamera, {.weight = 0.2f});
    double const step_m = 0.3 / kCamera.fx * 2;
    RenderedPair in, out;
    for (int i = 0; i < 40; ++i) {
        in = unchanged_pair(kFrameSize);
        for (int y = 0; y < kFrameSize.height; ++y)
            for (int x = 0; x < kFrameSize.width; ++x)
                in.with.at<cv::Vec3f>(y, x) += cv::Vec3f::all(std::sin((x + 0.3 * i) * 1.2) > 0 ? 0.3f : 0.1f);
        gi::RigidPose pose;
        pose.position.x = step_m * i;
        out = filter(in, depth, pose, i > 0 ? SceneChange::none : SceneChange::unknown);
    }
    auto const contrast = [](RenderedPair const& pair) {
        cv::Scalar mean, deviation;
        cv::meanStdDev((pair.with - pair.without)(kShadow), mean, deviation);
        return deviation[0];
    };
    EXPECT_GT(contrast(out), 0.4 * contrast(in)); // means of all frames leave a tenth
}

TEST(TemporalFilter, KeepsNothingNothing)
{
    cv::Mat const depth(kFrameSize, CV_32FC1, cv::Scalar(2));
    TemporalFilter filter(kCamera);
    for (int i = 0; i < 5; ++i) {
        RenderedPair const out = filter(noisy_shadow(i), depth, {});
        EXPECT_TRUE(equal(out.with.colRange(0, 20), out.without.colRange(0, 20)));
    }
    // The object is taken away: nothing of it stays.
    RenderedPair none = unchanged_pair(kFrameSize);
    RenderedPair const out = filter(none, depth, {});
    EXPECT_TRUE(equal(out.with, none.with));
    EXPECT_TRUE(equal(out.without, none.without));
}

TEST(TemporalFilter, FollowsSurfacesByPose)
{
    // A texture of changes on a plane at 2 m; the camera moves 3.5 pixels to the right between frames.
    TemporalFilter filter(kCamera, {.weight = 0.1f, .gamma = std::numeric_limits<float>::infinity()});
    cv::Mat const depth(kFrameSize, CV_32FC1, cv::Scalar(2));
    double const step_m = 3.5 / kCamera.fx * 2;
    auto const change_at = [](double world_px) { return float(0.2 * std::sin(world_px / 6)); };
    RenderedPair out;
    double now_error = 0, still_error = 0;
    for (int i = 0; i < 8; ++i) {
        RenderedPair pair = unchanged_pair(kFrameSize);
        for (int y = 0; y < kFrameSize.height; ++y)
            for (int x = 0; x < kFrameSize.width; ++x)
                pair.with.at<cv::Vec3f>(y, x) += cv::Vec3f::all(change_at(x + 3.5 * i));
        gi::RigidPose pose;
        pose.position.x = step_m * i;
        out = filter(pair, depth, pose);
        now_error = cv::norm(out.with.colRange(0, 60), pair.with.colRange(0, 60), cv::NORM_INF);
        still_error = filter.counts().fresh;
    }
    EXPECT_LT(now_error, 0.02) << "rounding of the lookup only; without poses it is 0.3";
    EXPECT_NEAR(still_error, 72 * 3, 72) << "what came into view";
}

TEST(TemporalFilter, DropsHistoryOfOtherSurfaces)
{
    TemporalFilter filter(kCamera, {.weight = 0.1f, .gamma = std::numeric_limits<float>::infinity()});
    cv::Mat depth(kFrameSize, CV_32FC1, cv::Scalar(2));
    filter(noisy_shadow(1), depth, {});
    depth.colRange(48, 96) = 1;
    RenderedPair const in = noisy_shadow(2), out = filter(in, depth, {});
    EXPECT_TRUE(equal(out.with.colRange(48, 96), in.with.colRange(48, 96)));
    EXPECT_EQ(filter.counts().fresh, std::size_t(48 * 72));
    RenderedPair covered = noisy_shadow(3);
    covered.coverage = cv::Scalar(1);
    EXPECT_TRUE(equal(filter(covered, depth, {}).with, covered.with)) << "another thing";
    filter.forget();
    EXPECT_TRUE(equal(filter(in, depth, {}).with, in.with));
}

TEST(TemporalFilter, SurvivesWhatIsNotFinite)
{
    TemporalFilter filter(kCamera);
    cv::Mat const depth(kFrameSize, CV_32FC1, cv::Scalar(2));
    RenderedPair bad = noisy_shadow(0);
    bad.with.at<cv::Vec3f>(30, 50)[1] = std::numeric_limits<float>::quiet_NaN();
    filter(bad, depth, {});
    for (int i = 1; i < 3; ++i) {
        RenderedPair const out = filter(noisy_shadow(i), depth, {});
        EXPECT_TRUE(cv::checkRange(out.with));
    }
}

TEST(TemporalFilter, RefusesWhatDoesNotFit)
{
    CameraModel lens = kCamera;
    lens.lens = LensModel::fisheye;
    EXPECT_THROW(TemporalFilter{lens}, gi::InputError);
    EXPECT_THROW(TemporalFilter(kCamera, {.weight = 0}), gi::InputError);
    TemporalFilter filter(kCamera);
    EXPECT_THROW(filter(unchanged_pair(kFrameSize), cv::Mat(), {}), gi::InputError);
}

} // namespace
} // namespace ar::test
