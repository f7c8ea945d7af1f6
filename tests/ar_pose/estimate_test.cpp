#include "ar/pose/estimate.h"

#include "gi/core/quantile.h"
#include "tests/ar_pose/synthetic.h"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <limits>

namespace ar::test {
namespace {

struct Errors {
    std::vector<double> mm, deg;

    void add(gi::RigidPose const& found, gi::RigidPose const& truth)
    {
        mm.push_back(1e3 * glm::length(found.position - truth.position));
        deg.push_back(angle_between_deg(found.rotation, truth.rotation));
    }
    void print(std::string const& what) const
    {
        fmt::print("{}: median {:.3f} mm {:.4f} deg, 95 % {:.3f} mm {:.4f} deg, most {:.3f} mm {:.4f} deg\n", what,
                   gi::quantile(mm, 0.5), gi::quantile(deg, 0.5), gi::quantile(mm, 0.95), gi::quantile(deg, 0.95),
                   gi::quantile(mm, 1), gi::quantile(deg, 1));
    }
};

class PoseOf : public testing::TestWithParam<LensModel> {};
INSTANTIATE_TEST_SUITE_P(All, PoseOf,
                         testing::Values(LensModel::pinhole, LensModel::radial_tangential, LensModel::fisheye),
                         [](auto const& p) { return name_of(p.param); });

TEST_P(PoseOf, GridOfMarkersAtAMetreIsRightToAMillimetre)
{
    CameraModel const camera = camera_640(GetParam());
    std::mt19937 random(7);
    for (double const noise : {0.1, 0.2}) {
        Errors errors;
        double normalised = 0;
        for (int i = 0; i < 300; ++i) {
            gi::RigidPose const truth = random_view(random, 1);
            PoseEstimate const e = estimate_pose(sight(marker_grid(), camera, truth, noise, random), camera);
            ASSERT_TRUE(e.found()) << name_of(e.failure);
            EXPECT_GE(e.points_used, 34);
            EXPECT_EQ(e.points_used + e.points_rejected, 36);
            errors.add(e.world_from_camera, truth);
            glm::dvec3 const d = e.world_from_camera.position - truth.position;
            for (int k = 0; k < 3; ++k) normalised += std::pow(d[k] / e.position_sigma_m[k], 2) / 900;
        }
        errors.print(fmt::format("{} {:.1f} px", name_of(GetParam()), noise));
        EXPECT_LE(gi::quantile(errors.mm, 0.5), GetParam() == LensModel::fisheye ? 2 * 10 * noise : 10 * noise);
        EXPECT_LE(gi::quantile(errors.deg, 0.5), GetParam() == LensModel::fisheye ? 0.2 : 0.1);
        EXPECT_NEAR(normalised, 1, 0.35); // the standard deviations are those of the errors
    }
}

TEST(Pose, OfExactPointsIsExact)
{
    std::mt19937 random(3);
    for (auto const& points : {marker_grid(), one_marker(0.2)})
        for (int i = 0; i < 30; ++i) {
            gi::RigidPose const truth = random_view(random, 0.8);
            PoseEstimate const e = estimate_pose(sight(points, camera_640(), truth, 0, random), camera_640());
            ASSERT_TRUE(e.found());
            EXPECT_LT(glm::length(e.world_from_camera.position - truth.position), 1e-6);
            EXPECT_LT(e.rms_px, 1e-6);
        }
}

TEST(Pose, OfMarkersOnTwoWallsComesFromPointsInSpace)
{
    std::mt19937 random(4);
    std::vector<SightedPoint> points = marker_grid();
    for (std::size_t i = 0; i < 20; ++i) std::swap(points[i].world_m.y, points[i].world_m.x);
    Errors errors;
    for (int i = 0; i < 60; ++i) {
        gi::RigidPose const truth = random_view(random, 1);
        PoseEstimate const e = estimate_pose(sight(points, camera_640(), truth, 0.1, random), camera_640());
        ASSERT_TRUE(e.found());
        EXPECT_FALSE(e.ambiguous);
        errors.add(e.world_from_camera, truth);
    }
    errors.print("two walls 0.1 px");
    EXPECT_LT(gi::quantile(errors.mm, 0.5), 1);
}

TEST(Pose, LeavesOutAMarkerThatWasMoved)
{
    std::mt19937 random(5);
    for (int moved : {0, 4, 8}) {
        gi::RigidPose const truth = random_view(random, 1);
        auto points = marker_grid();
        for (auto& p : points)
            if (p.marker == moved) p.world_m += glm::dvec3(0.03, 0, 0.01); // where it was when the map was made
        Sighting s = sight(marker_grid(), camera_640(), truth, 0.1, random);
        for (std::size_t i = 0; i < points.size(); ++i) s.points[i].world_m = points[i].world_m;
        PoseEstimate const e = estimate_pose(s, camera_640());
        ASSERT_TRUE(e.found());
        EXPECT_EQ(e.markers_rejected, std::vector<int>{moved});
        EXPECT_GE(e.points_rejected, 4);
        EXPECT_LT(glm::length(e.world_from_camera.position - truth.position), 0.004);
        EXPECT_LT(e.confidence, 0.9);
    }
}

TEST(Pose, LeavesOutFourOfNineMarkersThatWereMovedApart)
{
    std::mt19937 random(6);
    gi::RigidPose const truth = random_view(random, 1);
    Sighting s = sight(marker_grid(), camera_640(), truth, 0.1, random);
    for (auto& p : s.points)
        if (p.marker < 4) p.world_m += 0.05 * glm::dvec3(std::sin(3.0 * p.marker), 0.5, std::cos(2.0 * p.marker));
    PoseEstimate const e = estimate_pose(s, camera_640());
    ASSERT_TRUE(e.found());
    EXPECT_EQ(e.markers_rejected, (std::vector<int>{0, 1, 2, 3}));
    EXPECT_LT(glm::length(e.world_from_camera.position - truth.position), 0.005);
}

TEST(Pose, LeavesOutSinglePointsOfABoard)
{
    std::mt19937 random(8);
    for (int round = 0; round < 10; ++round) {
        gi::RigidPose const truth = random_view(random, 1);
        auto board = marker_grid();
        for (auto& p : board) p.marker = 0;
        Sighting s = sight(board, camera_640(), truth, 0.1, random);
        for (std::size_t i : {3u, 11u, 20u, 21u, 35u}) s.points[i].pixel += glm::dvec2(30.0 - double(i), 12);
        PoseEstimate const e = estimate_pose(s, camera_640());
        ASSERT_TRUE(e.found());
        EXPECT_GE(e.points_rejected, 5);
        EXPECT_LE(e.points_rejected, 7);
        EXPECT_LT(glm::length(e.world_from_camera.position - truth.position), 0.004);
    }
}

TEST(Pose, OfASmallFarMarkerIsSaidToBeAmbiguousAndTheLastPoseDecides)
{
    std::mt19937 random(9);
    int ambiguous = 0, right_alone = 0, right_with_last = 0;
    int const n = 60;
    for (int i = 0; i < n; ++i) {
        double const tilt = glm::radians(12.0);
        gi::RigidPose const truth =
            looking(2.5 * glm::dvec3(std::sin(tilt), std::cos(tilt), 0), {0, 0, 0}, 0.1 * i);
        Sighting const s = sight(one_marker(0.05), camera_640(), truth, 0.15, random);
        PoseEstimate const alone = estimate_pose(s, camera_640());
        ASSERT_TRUE(alone.found());
        gi::RigidPose const last{truth.position + glm::dvec3(0.02, 0.01, -0.03),
                                 glm::normalize(truth.rotation * gi::exp_rotation({0.02, -0.02, 0.01}))};
        PoseEstimate const with = estimate_pose(s, camera_640(), last);
        if (alone.ambiguous) {
            ++ambiguous;
            ASSERT_TRUE(alone.other);
            EXPECT_LE(alone.other_likelihood, 0.5);
            EXPECT_LT(alone.confidence, 0.995);
        }
        auto const near = [&](PoseEstimate const& e) {
            return glm::length(e.world_from_camera.position - truth.position) < 0.5;
        };
        right_alone += near(alone);
        right_with_last += near(with);
    }
    fmt::print("marker of 50 mm at 2.5 m, 12 deg: {} of {} ambiguous, {} right alone, {} with the last pose\n",
               ambiguous, n, right_alone, right_with_last);
    EXPECT_GT(ambiguous, n / 3);
    EXPECT_GE(right_with_last, right_alone);
    EXPECT_GE(right_with_last, n * 8 / 10);
}

TEST(Pose, OfALargeTiltedMarkerIsNotAmbiguous)
{
    std::mt19937 random(10);
    for (int i = 0; i < 20; ++i) {
        gi::RigidPose const truth = looking({0.5, 0.5, 0.1 * i - 1}, {0, 0, 0});
        PoseEstimate const e =
            estimate_pose(sight(one_marker(0.25), camera_640(), truth, 0.1, random), camera_640());
        ASSERT_TRUE(e.found());
        EXPECT_FALSE(e.ambiguous);
        EXPECT_GT(e.confidence, 0.5);
        EXPECT_LT(glm::length(e.world_from_camera.position - truth.position), 0.01);
    }
}

TEST(Pose, OfTooLittleIsAFailureWithItsReason)
{
    std::mt19937 random(11);
    gi::RigidPose const truth = looking({0.2, 1, 0.1}, {0, 0, 0});
    Sighting const whole = sight(marker_grid(), camera_640(), truth, 0.1, random);
    for (std::size_t n : {0u, 1u, 2u, 3u}) {
        Sighting s = whole;
        s.points.resize(n);
        PoseEstimate const e = estimate_pose(s, camera_640(), truth);
        EXPECT_EQ(e.failure, PoseFailure::too_few_points);
        EXPECT_EQ(e.points_rejected, int(n));
        EXPECT_EQ(e.confidence, 0);
    }
    Sighting twice = whole; // three points, each twice
    twice.points.resize(3);
    for (std::size_t i = 0; i < 3; ++i) twice.points.push_back(twice.points[i]);
    EXPECT_EQ(estimate_pose(twice, camera_640()).failure, PoseFailure::too_few_points);
    std::vector<SightedPoint> line;
    for (int i = 0; i < 8; ++i) line.push_back({{0.05 * i, 0, 0.02 * i}, {}, i / 4, 0.1});
    EXPECT_EQ(estimate_pose(sight(line, camera_640(), truth, 0.1, random), camera_640()).failure,
              PoseFailure::on_a_line);
    std::vector<SightedPoint> tee = line; // a line and one point beside it
    tee.push_back({{0.1, 0, 0.2}, {}, 0, 0.1});
    PoseEstimate const e = estimate_pose(sight(tee, camera_640(), truth, 0.01, random), camera_640());
    ASSERT_TRUE(e.found());
    EXPECT_LT(glm::length(e.world_from_camera.position - truth.position), 0.05);
}

TEST(Pose, OfPointsSeenTwiceIsThatOfPointsSeenOnce)
{
    std::mt19937 random(12);
    gi::RigidPose const truth = looking({0.2, 1, 0.1}, {0, 0, 0});
    Sighting s = sight(marker_grid(), camera_640(), truth, 0.1, random);
    gi::RigidPose const once = estimate_pose(s, camera_640()).world_from_camera;
    s.points.insert(s.points.end(), s.points.begin(), s.points.begin() + 36);
    PoseEstimate const twice = estimate_pose(s, camera_640());
    ASSERT_TRUE(twice.found());
    EXPECT_LT(glm::length(twice.world_from_camera.position - once.position), 2e-4);
}

TEST(Pose, OfWhatIsNotFiniteIsNotTaken)
{
    std::mt19937 random(13);
    gi::RigidPose const truth = looking({0.2, 1, 0.1}, {0, 0, 0});
    Sighting s = sight(marker_grid(), camera_640(), truth, 0.1, random);
    double const nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    s.points[0].pixel.x = nan;
    s.points[5].world_m.z = inf;
    s.points[9].sigma_px = nan;
    s.points[10].sigma_px = 0;
    PoseEstimate const e = estimate_pose(s, camera_640());
    ASSERT_TRUE(e.found());
    EXPECT_GE(e.points_rejected, 4);
    EXPECT_LE(e.points_rejected, 6);
    for (auto& p : s.points) p.pixel = {nan, nan};
    EXPECT_EQ(estimate_pose(s, camera_640()).failure, PoseFailure::too_few_points);
}

TEST(Pose, FarFromTheOriginAndOfOtherSizesIsAsGood)
{
    for (double const scale : {1e-3, 1.0, 1e5}) {
        std::mt19937 random(14);
        glm::dvec3 const offset = 1e6 * scale * glm::dvec3(1, -2, 3);
        gi::RigidPose truth = looking({0.2, 1, 0.1}, {0, 0, 0});
        Sighting s = sight(marker_grid(), camera_640(), truth, 0.1, random);
        for (auto& p : s.points) p.world_m = scale * p.world_m + offset;
        PoseEstimate const e = estimate_pose(s, camera_640());
        ASSERT_TRUE(e.found()) << scale;
        EXPECT_LT(glm::length(e.world_from_camera.position - (scale * truth.position + offset)), 0.003 * scale);
    }
}

TEST(Pose, OfPicturesThatNoCameraTakesIsAFailure)
{
    std::mt19937 random(15);
    gi::RigidPose const truth = looking({0.2, 1, 0.1}, {0, 0, 0});
    // What is behind a pinhole would be shown turned half about: the mirror image, which in space no pose shows.
    std::vector<SightedPoint> walls = marker_grid();
    for (std::size_t i = 0; i < 20; ++i) std::swap(walls[i].world_m.y, walls[i].world_m.x);
    Sighting behind = sight(walls, camera_640(), truth, 0.1, random);
    for (auto& p : behind.points) p.world_m = -p.world_m;
    PoseEstimate const mirrored = estimate_pose(behind, camera_640());
    EXPECT_LT(mirrored.confidence, 0.6) << mirrored.rms_px;
    Sighting noise = sight(marker_grid(), camera_640(), truth, 0.1, random);
    std::uniform_real_distribution<double> u(0, 480);
    for (auto& p : noise.points) p.pixel = {u(random), u(random)};
    EXPECT_EQ(estimate_pose(noise, camera_640()).failure, PoseFailure::no_agreement);
    Sighting one = noise;
    for (auto& p : one.points) p.pixel = {320, 240};
    EXPECT_FALSE(estimate_pose(one, camera_640()).found());
}

TEST(Pose, OfALastPoseThatIsNotFiniteIsThatWithoutIt)
{
    std::mt19937 random(17);
    gi::RigidPose const truth = looking({0.2, 1, 0.1}, {0, 0, 0});
    Sighting const s = sight(one_marker(0.05), camera_640(), truth, 0.1, random);
    double const nan = std::numeric_limits<double>::quiet_NaN();
    PoseEstimate const alone = estimate_pose(s, camera_640());
    PoseEstimate const with = estimate_pose(s, camera_640(), gi::RigidPose{{nan, nan, 0}, {nan, 0, 0, 0}});
    ASSERT_TRUE(alone.found() && with.found());
    EXPECT_LT(glm::length(alone.world_from_camera.position - with.world_from_camera.position), 1e-6);
}

TEST(Pose, OfAFisheyeReachesBeyondTheHemisphere)
{
    CameraModel const camera = camera_640(LensModel::fisheye);
    std::mt19937 random(16);
    // The camera stands among markers at the height of its eye, some of them behind it.
    std::vector<SightedPoint> points;
    for (int m = 0; m < 12; ++m)
        for (int c = 0; c < 4; ++c) {
            double const turn = glm::radians(-100.0 + 200.0 * m / 11) + (c == 1 || c == 2 ? 0.04 : -0.04);
            points.push_back(
                {{2 * std::sin(turn), (m % 3) * 0.3 + (c >= 2 ? 0.08 : -0.08), 2 * std::cos(turn)}, {}, m, 0.1});
        }
    gi::RigidPose const truth = looking({0.05, 0.2, -0.02}, {0.1, 0.3, 2});
    PoseEstimate const e = estimate_pose(sight(points, camera, truth, 0.1, random), camera);
    ASSERT_TRUE(e.found());
    EXPECT_EQ(e.points_used, 48);
    EXPECT_LT(glm::length(e.world_from_camera.position - truth.position), 0.002);
}

} // namespace
} // namespace ar::test
