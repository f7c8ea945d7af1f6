// Photographs whose markers other detectors found, too. Their bytes are not ours: see SOURCES.md beside them.

#include "ar/markers/detect.h"
#include "ar/markers/refine.h"
#include "gi/core/quantile.h"
#include "tests/ar_markers/refinement_name.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <yaml-cpp/yaml.h>

namespace ar::test {
namespace {

std::filesystem::path const kData = std::filesystem::path(LIGHTWELL_SOURCE_DIR) / "../shared/data/ar";
#define NEEDS(folder)                                                                                             \
    if (!std::filesystem::exists(kData / folder)) GTEST_SKIP() << "SKIPPED: " << (kData / folder) << " is missing"

cv::Mat gray(std::filesystem::path const& file)
{
    return cv::imread((kData / file).string(), cv::IMREAD_GRAYSCALE);
}

FoundMarkers find(cv::Mat const& picture, std::string const& dictionary, Refinement refinement = Refinement::edges,
                  int enlarge = 1)
{
    DetectorSettings settings;
    settings.enlarge = enlarge;
    settings.refinement = refinement;
    return find_markers(picture, dictionary, search_settings(settings, picture.size()));
}

using Corners = std::array<cv::Point2d, 4>;

/// Clockwise from the upper left, of a list in this order. apriltag has (0, 0) at the upper left edge of the first
/// pixel, we have it in its middle.
Corners corners_in(YAML::Node const& list, std::array<std::size_t, 4> order, double shift = 0)
{
    Corners c;
    for (std::size_t i = 0; i < 4; ++i)
        c[i] = {list[order[i]][0].as<double>() + shift, list[order[i]][1].as<double>() + shift};
    return c;
}

/// RMS distance of corners in their best order of the four, and how far that is turned.
std::pair<double, int> apart(FoundMarker const& m, Corners const& reference)
{
    std::pair<double, int> best{1e9, 0};
    for (int turn = 0; turn < 4; ++turn) {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            cv::Point2d const d = cv::Point2d(m.corners[i]) - reference[(i + std::size_t(turn)) % 4];
            sum += d.dot(d);
        }
        best = std::min(best, {std::sqrt(sum / 4), turn});
    }
    return best;
}

/// How much larger than the reference's the marker is, pixels per side.
double growth(FoundMarker const& m, Corners const& r)
{
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
        sum += cv::norm(m.corners[i] - m.corners[(i + 1) % 4]) - cv::norm(r[i] - r[(i + 1) % 4]);
    return sum / 4;
}

TEST(Photographs, AprilTagTurned)
{
    NEEDS("apriltag_rotation");
    auto const reference =
        YAML::LoadFile((kData / "apriltag_rotation/expected_detections.json").string())["images"];
    for (auto const refinement : {Refinement::edges, Refinement::subpixel, Refinement::apriltag}) {
        int seen = 0, expected = 0;
        double sum = 0, most = 0, larger = 0;
        for (auto const& entry : reference) {
            cv::Mat const picture = gray("apriltag_rotation/" + entry.first.Scalar());
            ++expected;
            auto const r = corners_in(entry.second[0]["corners_lb_rb_rt_lt"], {3, 2, 1, 0}, -0.5);
            for (FoundMarker const& m : find(picture, "DICT_APRILTAG_36h11", refinement).markers) {
                if (m.id != 76) continue;
                auto const [d, turn] = apart(m, r);
                if (d > 5) continue;
                ++seen;
                EXPECT_EQ(turn, 0) << "the marker stands upright in both";
                sum += d * d;
                most = std::max(most, d);
                larger += growth(m, r);
            }
        }
        fmt::print(
            "apriltag_rotation {}: {} of {} (apriltag 3.3: 15, OpenCV's aruco: 14); corners {:.3f} px rms from "
            "apriltag's, {:.3f} at most; sides {:+.3f} px\n",
            name_of(refinement), seen, expected, std::sqrt(sum / seen), most, larger / seen);
        if (refinement != Refinement::edges) continue;
        EXPECT_EQ(seen, 15);
        EXPECT_LT(std::sqrt(sum / seen), 0.6);
    }
}

TEST(Photographs, AprilTagsOutdoors)
{
    NEEDS("apriltag_umich");
    auto const reference =
        YAML::LoadFile((kData / "apriltag_umich/detections_apriltag33_defaults.json").string())["images"];
    for (auto const& [refinement, enlarge] : {std::pair{Refinement::edges, 1},
                                              {Refinement::edges, 2},
                                              {Refinement::subpixel, 1},
                                              {Refinement::apriltag, 1}}) {
        int seen = 0, of_theirs = 0, theirs = 0;
        double sum = 0;
        std::string each;
        for (auto const& entry : reference) {
            cv::Mat const picture = gray("apriltag_umich/" + entry.first.Scalar());
            auto const found = find(picture, "DICT_APRILTAG_36h11", refinement, enlarge);
            seen += int(found.markers.size());
            each += fmt::format(" {}/{}", found.markers.size(), entry.second.size());
            for (auto const& tag : entry.second) {
                ++theirs;
                auto const r = corners_in(tag["corners_lb_rb_rt_lt"], {3, 2, 1, 0}, -0.5);
                double least = 1e9;
                for (FoundMarker const& m : found.markers)
                    if (m.id == tag["id"].as<int>()) least = std::min(least, apart(m, r).first);
                if (least > 6) continue;
                ++of_theirs;
                sum += least * least;
            }
        }
        fmt::print(
            "apriltag_umich {} x{}: {} of apriltag's {} (by picture{}); corners {:.3f} px rms from apriltag's\n",
            name_of(refinement), enlarge, of_theirs, theirs, each, std::sqrt(sum / of_theirs));
        if (refinement != Refinement::edges) continue;
        EXPECT_EQ(of_theirs, 45);
        EXPECT_LT(std::sqrt(sum / of_theirs), 0.8);
    }
}

TEST(Photographs, ArucoOnAWall)
{
    NEEDS("aruco_ubiquity");
    auto const truth = YAML::LoadFile((kData / "aruco_ubiquity/ground_truth.json").string());
    std::string const file = "tag_245-246_d7_14cm.png";
    for (auto const refinement : {Refinement::edges, Refinement::subpixel}) {
        auto const found = find(gray("aruco_ubiquity/" + file), "DICT_5X5_1000", refinement);
        double most = 0, larger = 0;
        int seen = 0;
        for (FoundMarker const& m : found.markers) {
            auto const r = corners_in(truth["corners"][file][std::to_string(m.id)], {0, 1, 2, 3});
            auto const [d, turn] = apart(m, r);
            EXPECT_EQ(turn, 0);
            most = std::max(most, d);
            larger += growth(m, r);
            ++seen;
        }
        fmt::print("aruco_ubiquity {}: {} of 2; corners at most {:.3f} px rms from OpenCV's; sides {:+.3f} px\n",
                   name_of(refinement), seen, most, larger / seen);
        EXPECT_EQ(seen, 2);
        EXPECT_LT(most, 1.0);
    }
    auto const one = find(gray("aruco_ubiquity/403.jpg"), "DICT_5X5_1000");
    ASSERT_EQ(one.markers.size(), 1u);
    EXPECT_EQ(one.markers[0].id, 403);
}

TEST(Photographs, CharucoOnAScreen)
{
    NEEDS("charuco_lifecam_1280");
    auto const all = YAML::LoadFile((kData / "charuco_lifecam_1280/calibration.json").string());
    MarkerMap map;
    map.boards = {{8, 8, 0.0254, 0.01905, "DICT_4X4_1000", 0, false, {}}};
    auto const corners_m = inner_corners(map.boards[0]);
    std::vector<std::vector<cv::Point3f>> ours_m, theirs_m;
    std::vector<std::vector<cv::Point2f>> ours_px, theirs_px;
    int full = 0, ours = 0, theirs = 0;
    double sum = 0;
    cv::Point2d shift(0, 0);
    int both = 0;
    auto const detections = all["detections"];
    for (auto const& entry : detections) {
        Sighting const s = detect(gray("charuco_lifecam_1280/" + entry.first.Scalar()), map);
        full += s.points.size() == 49;
        ours += int(s.points.size());
        ours_m.emplace_back();
        ours_px.emplace_back();
        theirs_m.emplace_back();
        theirs_px.emplace_back();
        for (auto const& p : s.points) {
            ours_m.back().emplace_back(float(p.world_m.x), float(p.world_m.y), 0.f);
            ours_px.back().emplace_back(float(p.pixel.x), float(p.pixel.y));
        }
        auto const ids = entry.second["ids"], pixels = entry.second["corners_px"];
        theirs += int(ids.size());
        for (std::size_t i = 0; i < ids.size(); ++i) {
            glm::dvec3 const at = corners_m[ids[i].as<std::size_t>()];
            cv::Point2d const pixel(pixels[i][0].as<double>(), pixels[i][1].as<double>());
            theirs_m.back().emplace_back(float(at.x), float(at.y), 0.f);
            theirs_px.back().emplace_back(pixel);
            for (auto const& p : s.points)
                if (glm::distance(p.world_m, at) < 1e-9) {
                    cv::Point2d const d = cv::Point2d(p.pixel.x, p.pixel.y) - pixel;
                    shift += d;
                    sum += d.dot(d);
                    ++both;
                }
        }
    }
    cv::Mat k, d;
    std::vector<cv::Mat> r, t;
    auto const rms_of = [&](auto const& m, auto const& px, std::vector<double>& each) {
        cv::Mat std_in, std_ex, per_view;
        double const v = cv::calibrateCamera(m, px, {1280, 720}, k, d, r, t, std_in, std_ex, per_view);
        per_view.reshape(1, 1).copyTo(each);
        return v;
    };
    std::vector<double> each_ours, each_theirs;
    double const our_rms = rms_of(ours_m, ours_px, each_ours),
                 their_rms = rms_of(theirs_m, theirs_px, each_theirs);
    shift *= 1. / both;
    fmt::print("charuco_lifecam_1280: {} corners in {} pictures, {} with all 49 (OpenCV: {}); {:.3f} px rms from "
               "OpenCV's, of which ({:.3f}, {:.3f}) are its shift of (0.5, 0.5)\n",
               ours, detections.size(), full, theirs, std::sqrt(sum / both), shift.x, shift.y);
    fmt::print(
        "  reprojection after cv::calibrateCamera: {:.3f} px rms, median view {:.3f} (OpenCV's corners: {:.3f}, "
        "{:.3f}; as written down: {:.3f})\n",
        our_rms, gi::median(each_ours), their_rms, gi::median(each_theirs),
        all["opencv_4_6_calibration"]["rms_px"].as<double>());
    EXPECT_GE(full, 14);
    EXPECT_LT(our_rms, 0.3);

    // The board's markers must also be where its inner corners predict them.
    auto const placed = placed_markers(map);
    for (auto const refinement :
         {Refinement::edges, Refinement::subpixel, Refinement::contour, Refinement::none}) {
        double off = 0, larger = 0;
        int markers = 0;
        std::size_t view = 0;
        for (auto const& entry : detections) {
            auto const found =
                find(gray("charuco_lifecam_1280/" + entry.first.Scalar()), "DICT_4X4_1000", refinement);
            for (FoundMarker const& m : found.markers) {
                if (std::size_t(m.id) >= placed.size()) continue;
                std::vector<cv::Point3d> at;
                for (auto const& c : placed[std::size_t(m.id)].corners_m) at.emplace_back(c.x, c.y, 0);
                std::vector<cv::Point2d> px;
                cv::projectPoints(at, r[view], t[view], k, d, px);
                Corners const expected{px[0], px[1], px[2], px[3]};
                off += std::pow(apart(m, expected).first, 2);
                larger += growth(m, expected);
                ++markers;
            }
            ++view;
        }
        fmt::print(
            "  corners of its markers, {}: {:.3f} px rms from where its inner corners say, sides {:+.3f} px\n",
            name_of(refinement), std::sqrt(off / markers), larger / markers);
    }
}

} // namespace
} // namespace ar::test
