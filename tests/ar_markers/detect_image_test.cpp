#include "ar/markers/detect.h"

#include "gi/core/error.h"
#include "tests/ar_markers/drawn_view.h"
#include "tests/ar_markers/refinement_name.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace ar::test {
namespace {

CameraModel const kCamera{LensModel::radial_tangential, {640, 480}, 525, 525, 318.5, 243.25, {-0.2, 0.05}};

/// Four markers in a row and one above.
MarkerMap markers_of(std::string const& dictionary)
{
    MarkerMap map;
    for (int i = 0; i < 5; ++i)
        map.markers.push_back(
            {dictionary,
             3 * i + 1,
             0.08,
             {i < 4 ? glm::dvec3(0.13 * i - 0.195, 0, 0) : glm::dvec3(0, 0.14, 0), {1, 0, 0, 0}}});
    return map;
}

class OfDictionary : public testing::TestWithParam<char const*> {};
INSTANTIATE_TEST_SUITE_P(Some, OfDictionary,
                         testing::Values("DICT_4X4_50", "DICT_6X6_250", "DICT_APRILTAG_36h11",
                                         "DICT_ARUCO_ORIGINAL"),
                         [](auto const& p) { return std::string(p.param); });

TEST_P(OfDictionary, CornersAreWhereTheyAreDrawn)
{
    ViewSettings view;
    view.rays = 3;
    DrawnWorld const world(markers_of(GetParam()), kCamera, view);
    std::vector<gi::RigidPose> poses;
    std::vector<cv::Mat> pictures;
    for (glm::dvec3 const eye : {glm::dvec3(0, 0.05, 0.7), {0.4, 0.3, 0.6}, {-0.5, 0.1, 0.8}}) {
        poses.push_back(looking(eye, {0, 0.05, 0}));
        pictures.push_back(world.picture(poses.back(), poses.size()));
    }
    for (auto const refinement :
         {Refinement::none, Refinement::edges, Refinement::subpixel, Refinement::contour, Refinement::apriltag}) {
        std::vector<double> errors;
        int seen = 0;
        for (std::size_t i = 0; i < poses.size(); ++i) {
            DetectorSettings settings;
            settings.refinement = refinement;
            Sighting const found = detect(pictures[i], world.map(), settings);
            for (double e : world.errors(found, poses[i])) errors.push_back(e);
            seen += found.markers_seen;
        }
        fmt::print("{} {}: {} of 15 markers, corners off by {:.3f} px rms, {:.3f} at most\n", GetParam(),
                   name_of(refinement), seen, rms(errors), *std::max_element(errors.begin(), errors.end()));
        if (refinement != Refinement::edges) continue;
        EXPECT_EQ(seen, 15);
        EXPECT_LT(rms(errors), 0.16);
    }
}

class OfPattern : public testing::TestWithParam<std::tuple<int, int, bool>> {};
INSTANTIATE_TEST_SUITE_P(All, OfPattern,
                         testing::Combine(testing::Values(7, 8), testing::Values(5, 6), testing::Bool()));

TEST_P(OfPattern, InnerCornersAreWhereTheyAreDrawn)
{
    auto const [nx, ny, legacy] = GetParam();
    MarkerMap map;
    gi::RigidPose const turned{{0.1, -0.2, 0.05}, glm::angleAxis(0.3, glm::normalize(glm::dvec3(1, 2, 3)))};
    map.boards = {{nx, ny, 0.04, 0.03, "DICT_4X4_100", 11, legacy, turned}};
    ViewSettings settings;
    settings.rays = 3;
    DrawnWorld const world(map, kCamera, settings);
    glm::dvec3 const middle = turned * glm::dvec3(0.02 * nx, 0.02 * ny, 0);
    gi::RigidPose const pose = looking(middle + turned.rotation * glm::dvec3(0.1, 0.12, 0.45), middle);
    Sighting const s = detect(world.picture(pose), map);
    EXPECT_EQ(int(s.points.size()), (nx - 1) * (ny - 1));
    EXPECT_LT(rms(world.errors(s, pose)), 0.08) << s.points.size();
}

TEST(Detect, CountsWhatTheMapDoesNotKnow)
{
    DrawnWorld const world(markers_of("DICT_4X4_50"), kCamera);
    gi::RigidPose const pose = looking({0, 0.05, 0.7}, {0, 0.05, 0});
    cv::Mat picture = world.picture(pose);
    MarkerMap fewer = world.map();
    fewer.markers.resize(3);
    EXPECT_EQ(detect(picture, fewer).markers_seen, 3);
    EXPECT_EQ(detect(picture, fewer).markers_unknown, 2);
    // The left one a second time, in the place of the one above.
    MarkerMap twice = world.map();
    twice.markers[4].id = twice.markers[0].id;
    twice.markers[4].dictionary = "DICT_4X4_50";
    DrawnWorld const other(twice, kCamera);
    Sighting const s = detect(other.picture(pose), world.map());
    EXPECT_EQ(s.markers_seen, 3);
    EXPECT_EQ(s.markers_ambiguous, 2);
    EXPECT_EQ(s.points.size(), 12u);
    EXPECT_THROW(detect(cv::Mat(), world.map()), gi::InputError);
    EXPECT_THROW(detect(cv::Mat(9, 9, CV_8UC3), world.map()), gi::InputError);
    EXPECT_THROW(detect(picture, {}), gi::InputError);
    for (int side : {1, 2, 3, 7, 20})
        EXPECT_EQ(detect(cv::Mat(side, side, CV_8U, cv::Scalar(99)), world.map()).markers_seen, 0);
}

TEST(MarkerTracker, FindsWhatTheWholePictureHas)
{
    MarkerMap map = markers_of("DICT_4X4_50");
    map.boards = {{5, 4, 0.05, 0.038, "DICT_5X5_100", 0, false, {{-0.12, -0.28, 0}, {1, 0, 0, 0}}}};
    ViewSettings settings;
    settings.rays = 2;
    DrawnWorld const world(map, kCamera, settings);
    MarkerTracker tracker(map);
    std::vector<double> apart;
    for (int i = 0; i < 12; ++i) {
        double const a = 0.05 * i;
        // In the eighth picture the camera has been put elsewhere.
        glm::dvec3 const target(i == 7 ? 0.5 : 0.02 * i, 0, 0);
        gi::RigidPose const pose = looking({0.95 * std::sin(a), 0.2, 0.95 * std::cos(a)}, target);
        cv::Mat const picture = world.picture(pose, std::uint64_t(i));
        Sighting const whole = detect(picture, map), near = tracker.next(picture);
        EXPECT_LE(std::abs(near.markers_seen - whole.markers_seen), 1) << i; // another crop, other thresholds
        for (auto const& p : near.points) {
            double least = 1e9;
            for (auto const& q : whole.points)
                if (p.world_m == q.world_m) least = glm::distance(p.pixel, q.pixel);
            if (least < 1e9) apart.push_back(least);
        }
    }
    EXPECT_GT(apart.size(), 300u);
    EXPECT_LT(rms(apart), 0.05);
    EXPECT_EQ(tracker.counts().pictures, 12u);
    EXPECT_LT(tracker.counts().whole, 5u);
    EXPECT_GE(tracker.counts().in_vain, 1u);
}

} // namespace
} // namespace ar::test
