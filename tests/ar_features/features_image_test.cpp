// A camera found by what the place looks like: a map made along one way, used along another, with losses between.

#include "ar/features/feature_tracker.h"
#include "ar/features/map_builder.h"
#include "gi/core/error.h"
#include "gi/core/quantile.h"
#include "tests/support/stop_at_ask.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

/// A tabletop of 1.2 m x 1 m with squares of many sizes; nothing beyond.
cv::Mat tabletop()
{
    cv::RNG random(5);
    cv::Mat sum(1000, 1200, CV_32FC1, cv::Scalar(0));
    for (int const cell : {90, 37, 17}) {
        cv::Mat values(1000 / cell + 1, 1200 / cell + 1, CV_32FC1), large;
        random.fill(values, cv::RNG::UNIFORM, 0, 80);
        cv::resize(values, large, {values.cols * cell, values.rows * cell}, 0, 0, cv::INTER_NEAREST);
        sum += large(cv::Rect(0, 0, 1200, 1000));
    }
    cv::Mat out;
    sum.convertTo(out, CV_8U);
    return out;
}

CameraModel camera()
{
    return {LensModel::radial_tangential, {400, 300}, 350, 352, 201, 148, {-0.1, 0.03, 0, 0, 0}};
}

cv::Mat picture(gi::RigidPose const& world_from_camera, int frame)
{
    static cv::Mat const table = tabletop();
    CameraModel const c = camera();
    cv::Mat at(c.size_px.y, c.size_px.x, CV_32FC2), out, noise(at.size(), CV_16S);
    for (int y = 0; y < at.rows; ++y)
        for (int x = 0; x < at.cols; ++x) {
            glm::dvec3 const d = world_from_camera.rotation * *direction_of(c, {x, y});
            glm::dvec3 const p = world_from_camera.position - world_from_camera.position.y / d.y * d;
            bool const hit = d.y < 0;
            at.at<cv::Vec2f>(y, x) =
                hit ? cv::Vec2f(float(1000 * (p.x + 0.6)), float(1000 * (p.z + 0.5))) : cv::Vec2f(-1e4f, -1e4f);
        }
    cv::remap(table, out, at, {}, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(128));
    cv::GaussianBlur(out, out, {}, 0.6);
    cv::RNG(std::uint64_t(frame + 1)).fill(noise, cv::RNG::NORMAL, 0, 2);
    cv::add(out, noise, out, {}, CV_8U);
    return out;
}

gi::RigidPose looking_at(glm::dvec3 eye, glm::dvec3 at)
{
    glm::dvec3 const z = glm::normalize(at - eye), x = glm::normalize(glm::cross(z, glm::dvec3(0, 1, 0)));
    return {eye, glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)))};
}
gi::RigidPose first_way(int k)
{
    return looking_at({-0.25 + 0.018 * k, 0.62 + 0.04 * std::sin(0.3 * k), 0.45}, {0, 0, 0});
}
gi::RigidPose second_way(int k)
{
    return looking_at({0.12 * std::sin(0.12 * k), 0.55, 0.4 + 0.05 * std::cos(0.1 * k)}, {0.03, 0, 0.02});
}

class Features : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        MapBuilder builder(camera());
        for (int k = 0; k < 28; ++k) builder.add(picture(first_way(k), k), first_way(k));
        map = builder.finish();
        counts = builder.counts();
    }
    static inline FeatureMap map;
    static inline MapBuilderCounts counts;
};

TEST_F(Features, LieWhereTheyAre)
{
    ASSERT_GT(map.points.size(), 200u);
    std::vector<double> off_m;
    for (MapPoint const& p : map.points) off_m.push_back(std::abs(p.world_m.y));
    std::printf("%zu points of %zu tracks, %.2f mm from the table (median), %.2f mm (95 %%)\n", map.points.size(),
                counts.tracks, 1e3 * gi::quantile(off_m, 0.5), 1e3 * gi::quantile(off_m, 0.95));
    EXPECT_LT(gi::quantile(off_m, 0.5), 0.008);
    EXPECT_EQ(map.points.size() + counts.merged + counts.short_lived + counts.no_parallax + counts.bad_fit,
              counts.tracks);
}

TEST_F(Features, FindTheCameraAndFindItAgain)
{
    FeatureTracker tracker(map, camera());
    std::vector<double> mm, deg;
    std::optional<gi::RigidPose> expected;
    int found_again = -1;
    for (int k = 0; k < 60; ++k) {
        bool const covered = k >= 20 && k < 26, flat = k >= 40 && k < 43;
        cv::Mat gray = picture(second_way(k), 100 + k);
        if (covered) gray.setTo(90);
        if (flat) gray.setTo(0);
        Sighting seen;
        PoseEstimate const e = tracker.next(k / 30.0, gray, expected, seen);
        if (covered || flat) {
            EXPECT_FALSE(e.found()) << k;
            EXPECT_TRUE(seen.points.empty());
            expected.reset();
            continue;
        }
        ASSERT_TRUE(e.found()) << k;
        if (k >= 26 && found_again < 0) found_again = k;
        mm.push_back(1e3 * glm::length(e.world_from_camera.position - second_way(k).position));
        deg.push_back(angle_between_deg(e.world_from_camera.rotation, second_way(k).rotation));
        EXPECT_GT(e.confidence, 0.5) << k;
        expected = e.world_from_camera;
    }
    std::printf("%.2f mm (median), %.2f mm (most), %.3f degrees (median)\n", gi::quantile(mm, 0.5),
                gi::quantile(mm, 1.0), gi::quantile(deg, 0.5));
    EXPECT_EQ(found_again, 26) << "in the first picture";
    EXPECT_LT(gi::quantile(mm, 0.5), 5);
    EXPECT_LT(gi::quantile(mm, 1.0), 15);
    EXPECT_EQ(tracker.counts().relocated, 3u);
    EXPECT_EQ(tracker.counts().not_relocated, 9u);
}

TEST_F(Features, OfAnotherPlaceAreNotFound)
{
    FeatureTracker tracker(map, camera());
    cv::Mat other(300, 400, CV_8UC1);
    cv::RNG random(77);
    for (int k = 0; k < 8; ++k) {
        cv::Mat cells(30, 40, CV_8UC1);
        random.fill(cells, cv::RNG::UNIFORM, 0, 255);
        cv::resize(cells, other, other.size(), 0, 0, cv::INTER_NEAREST);
        Sighting seen;
        PoseEstimate const e = tracker.next(k / 30.0, other, {}, seen);
        EXPECT_TRUE(!e.found() || e.confidence < 0.5) << k;
    }
}

TEST_F(Features, LoseConfidenceWhereNothingIsRecognised)
{
    FeatureTrackerSettings settings;
    settings.look_every = 1000;
    FeatureTracker tracker(map, camera(), settings);
    double first = 0, last = 0;
    for (int k = 0; k < 30; ++k) {
        Sighting seen;
        PoseEstimate const e = tracker.next(k / 10.0, picture(second_way(k), 300 + k), {}, seen);
        if (k == 0) first = e.confidence;
        if (e.found()) last = e.confidence;
        if (tracker.flow_s() > 2) break;
    }
    EXPECT_GT(tracker.flow_s(), 1);
    EXPECT_LT(last, 0.7 * first);
}

TEST_F(Features, LoseConfidenceWhereTheSearchFindsNone)
{
    FeatureTrackerSettings settings;
    settings.near_px = 1e-9;
    FeatureTracker tracker(map, camera(), settings);
    double first = 0, last = 0;
    for (int k = 0; k < 30 && tracker.flow_s() <= 2; ++k) {
        Sighting seen;
        PoseEstimate const e = tracker.next(k / 10.0, picture(second_way(k), 300 + k), {}, seen);
        if (k == 0) first = e.confidence;
        if (e.found()) last = e.confidence;
    }
    EXPECT_GT(tracker.counts().looked, 3u);
    EXPECT_GT(tracker.flow_s(), 1);
    EXPECT_LT(last, 0.7 * first);
}

TEST(FeatureMaps, OfNothingAreEmpty)
{
    MapBuilder builder(camera());
    for (int k = 0; k < 5; ++k) builder.add(cv::Mat(300, 400, CV_8UC1, cv::Scalar(70)), first_way(k));
    EXPECT_TRUE(builder.finish().points.empty());
    MapBuilder still(camera()); // a camera that does not move sees from one side only
    for (int k = 0; k < 6; ++k) still.add(picture(first_way(0), k), first_way(0));
    EXPECT_TRUE(still.finish().points.empty());
    FeatureTracker tracker({}, camera());
    Sighting seen;
    EXPECT_FALSE(tracker.next(0, picture(first_way(0), 0), {}, seen).found());
}

TEST_F(Features, AreReadAsTheyWereWritten)
{
    std::string const text = format_feature_map(map);
    FeatureMap const again = parse_feature_map(text, "map.txt");
    ASSERT_EQ(again.points.size(), map.points.size());
    for (std::size_t k = 0; k < map.points.size(); ++k) {
        EXPECT_LT(glm::length(again.points[k].world_m - map.points[k].world_m), 2e-6);
        EXPECT_EQ(again.points[k].descriptors, map.points[k].descriptors);
    }
}

TEST(FeatureMaps, ThatCannotBeMatchedAreRefused)
{
    FeatureMap large;
    large.points.resize(kMostDescriptorsOfMap / kMostDescriptors + 1);
    for (MapPoint& p : large.points) p.descriptors.resize(kMostDescriptors);
    EXPECT_THROW(FeatureTracker(large, camera()), gi::InputError);
    large.points.back().descriptors.resize(kMostDescriptorsOfMap % kMostDescriptors);
    cv::Mat const gray = picture(first_way(0), 0);
    FeatureTracker tracker(large, camera());
    Sighting seen;
    gi::test::StopAtAsk never;
    EXPECT_FALSE(tracker.next(0, gray, {}, seen, &never).found()) << "nor does OpenCV's matcher throw";
    EXPECT_GE(never.asks(), 5u) << "it matches few at once";
    gi::test::StopAtAsk stop(2);
    EXPECT_FALSE(tracker.next(0.1, gray, {}, seen, &stop).found());
    EXPECT_EQ(stop.asks(), 2u);
    std::string const d(64, 'a');
    std::string text = "lightwell features 1\n";
    for (std::size_t k = 0; k <= kMostDescriptorsOfMap; ++k) text += "1 2 3 0.1 " + d + "\n";
    try {
        parse_feature_map(text, "map.txt");
        ADD_FAILURE();
    } catch (gi::InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("'map.txt' has 262144 points with 262144 descriptors"),
                  std::string::npos);
    }
}

TEST(FeatureMaps, ThatAreBrokenSayWhere)
{
    std::string const d(64, 'a'), head = "lightwell features 1\n";
    auto const refusal = [](std::string const& text) {
        try {
            parse_feature_map(text, "map.txt");
        } catch (gi::InputError const& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_EQ(refusal(head + "1 2 3 0.001 " + d + "\n"), "");
    EXPECT_EQ(refusal("").find("map.txt"), 0u);
    EXPECT_NE(refusal("").find("no points"), std::string::npos);
    EXPECT_EQ(refusal("ply\n").find("map.txt:1:1"), 0u) << refusal("ply\n");
    EXPECT_EQ(refusal(head + "1 2 nan 0.001 " + d + "\n").find("map.txt:2:5"), 0u);
    EXPECT_EQ(refusal(head + "\n1 2 3 -1 " + d + "\n").find("map.txt:3:7"), 0u);
    EXPECT_EQ(refusal(head + "1 2 3 0.1 " + d.substr(1) + "\n").find("map.txt:2:11"), 0u);
    EXPECT_EQ(refusal(head + "1 2 3 0.1 " + d.substr(1) + "g\n").find("map.txt:2:11"), 0u);
    EXPECT_EQ(refusal(head + "1 2 3\n").find("map.txt:2:1"), 0u);
    EXPECT_EQ(refusal(head + "1 2 3 0.1\n").find("map.txt:2:1"), 0u);
}

} // namespace
} // namespace ar::test
