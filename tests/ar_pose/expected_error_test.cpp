#include "ar/pose/expected_error.h"

#include "ar/pose/fused.h"
#include "tests/ar_pose/synthetic.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace ar::test {
namespace {

TEST(ExpectedError, IsThatOfTheEstimates)
{
    struct Case {
        std::vector<SightedPoint> points;
        double distance_m;
        bool is_doubtful;
    };
    CameraModel const camera = camera_640();
    for (Case const& c : {Case{marker_grid(), 0.8, false}, Case{marker_grid(), 2.5, false},
                          Case{one_marker(0.05), 0.3, false}, Case{one_marker(0.05), 2.5, true}}) {
        std::mt19937 random(3);
        double sum = 0, expected = 0;
        int n = 0, doubtful = 0;
        for (int i = 0; i < 200; ++i) {
            // 45 degrees from above: the mirrored pose of a far marker fits nearly as well.
            gi::RigidPose const truth = looking(c.distance_m * glm::dvec3(0.5, 0.707, 0.5), {0, 0, 0}, 0.01 * i);
            PoseEstimate const e = estimate_pose(sight(c.points, camera, truth, 0.15, random), camera);
            if (!e.found()) continue;
            ++n;
            double const off = glm::length(e.world_from_camera.position - truth.position);
            double const said = e.expected_error_m.value();
            EXPECT_NEAR(e.distance_m, c.distance_m, 0.2 * c.distance_m);
            sum += off * off;
            expected += said * said;
            doubtful += said > kDoubtfulErrorShare * e.distance_m;
        }
        ASSERT_GT(n, 100);
        double const rms = std::sqrt(sum / n), said = std::sqrt(expected / n);
        fmt::print("{} points at {} m: {:.1f} mm RMS, {:.1f} expected; {} of {} in doubt\n", c.points.size(),
                   c.distance_m, 1e3 * rms, 1e3 * said, doubtful, n);
        EXPECT_GT(said, 0.5 * rms);
        EXPECT_LT(said, 2 * rms);
        EXPECT_EQ(doubtful > n / 2, c.is_doubtful);
    }
}

TEST(ExpectedError, IsUnknownForPosesThatWereNotEstimated)
{
    PoseEstimate e;
    EXPECT_FALSE(expected_error(e)) << "failed";
    e.failure = PoseFailure::none;
    EXPECT_FALSE(expected_error(e)) << "of a file";
    e.covariance(0, 0) = 1e-4;
    EXPECT_NEAR(expected_error(e).value(), 0.01, 1e-12);
    e.other = gi::RigidPose{{0, 2, 0}, {1, 0, 0, 0}};
    e.other_likelihood = 0.25;
    EXPECT_NEAR(expected_error(e).value(), std::sqrt(1 + 1e-4), 1e-9);
}

TEST(ExpectedError, OfFusedPosesIsNotThatOfEarlierHypotheses)
{
    // One near marker: the mirrored pose does not fit, whatever the fusion keeps of it.
    CameraModel const camera = camera_640();
    std::mt19937 random(4);
    PoseFusion fusion;
    for (int i = 0; i < 30; ++i) {
        gi::RigidPose const truth = looking(glm::dvec3(0.2 + 0.004 * i, 0.4, 0.25), {0, 0, 0});
        PoseEstimate const e =
            fusion.next(i / 30.0, estimate_pose(sight(one_marker(0.07), camera, truth, 0.05, random), camera));
        ASSERT_TRUE(e.found());
        EXPECT_LT(e.expected_error_m.value(), kDoubtfulErrorShare * e.distance_m) << i;
    }
}

} // namespace
} // namespace ar::test
