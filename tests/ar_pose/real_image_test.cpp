// Poses from corners that others found in photographs, beside the poses that OpenCV gives.

#include "ar/pose/estimate.h"
#include "gi/core/quantile.h"
#include "gi/core/rotation.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace ar::test {
namespace {

namespace fs = std::filesystem;

fs::path const kData = fs::path(LIGHTWELL_SOURCE_DIR) / "../shared/data/ar";

nlohmann::json read(fs::path const& file)
{
    std::ifstream in(file);
    return nlohmann::json::parse(in);
}

cv::Vec3d vec3(nlohmann::json const& v) { return {v[0], v[1], v[2]}; }

CameraModel camera_of(nlohmann::json const& k, nlohmann::json const& distortion, glm::ivec2 size)
{
    CameraModel c{LensModel::radial_tangential, size, k[0], k[1], k[2], k[3], {}};
    for (std::size_t i = 0; i < 5; ++i) c.distortion[i] = distortion[i];
    return c;
}

TEST(Photographs, OfABoardGiveThePosesOfItsCalibration)
{
    fs::path const file = kData / "charuco_lifecam_1280/calibration.json";
    if (!fs::exists(file)) GTEST_SKIP() << "SKIPPED: no shared data";
    nlohmann::json const all = read(file);
    nlohmann::json const& cal = all["opencv_4_6_calibration"];
    nlohmann::json const& k = cal["K"];
    CameraModel const camera =
        camera_of({k[0][0], k[1][1], k[0][2], k[1][2]}, cal["dist_k1k2p1p2k3"], {1280, 720});
    double const square = all["board"]["square_m"];
    std::vector<double> mm, deg;
    double ours = 0, theirs = 0;
    int rejected = 0, points = 0;
    for (std::size_t v = 0; v < cal["files"].size(); ++v) {
        nlohmann::json const& found = all["detections"][std::string(cal["files"][v])];
        Sighting s;
        for (std::size_t i = 0; i < found["ids"].size(); ++i) {
            int const id = found["ids"][i];
            s.points.push_back({{(id % 7 + 1) * square, (id / 7 + 1) * square, 0},
                                {found["corners_px"][i][0], found["corners_px"][i][1]},
                                0,
                                0.3});
        }
        PoseEstimate const e = estimate_pose(s, camera);
        ASSERT_TRUE(e.found()) << v;
        gi::RigidPose const reference = inverse(pose_of(vec3(cal["rvecs"][v]), vec3(cal["tvecs_m"][v])));
        mm.push_back(1e3 * glm::length(reference.position - e.world_from_camera.position));
        deg.push_back(angle_between_deg(reference.rotation, e.world_from_camera.rotation));
        ours += e.rms_px / double(cal["files"].size());
        theirs += double(cal["per_view_rms_px"][v]) / double(cal["files"].size());
        rejected += e.points_rejected;
        points += e.points_rejected + e.points_used;
    }
    std::sort(mm.begin(), mm.end());
    std::sort(deg.begin(), deg.end());
    fmt::print("16 photographs of a board: {:.2f} mm and {:.3f} deg from OpenCV's on the median, most {:.2f} mm "
               "and {:.3f} "
               "deg; mean rms {:.3f} px (OpenCV {:.3f}), {} of {} corners left out\n",
               gi::quantile_of_sorted(mm, 0.5), gi::quantile_of_sorted(deg, 0.5), mm.back(), deg.back(), ours,
               theirs, rejected, points);
    EXPECT_LT(gi::quantile_of_sorted(mm, 0.5), 1);
    EXPECT_LT(gi::quantile_of_sorted(deg, 0.5), 0.1);
    EXPECT_LT(ours, theirs + 0.01);
}

TEST(Photographs, OfATagTurnedGiveItsTurns)
{
    fs::path const file = kData / "apriltag_rotation/expected_detections.json";
    if (!fs::exists(file)) GTEST_SKIP() << "SKIPPED: no shared data";
    CameraModel const camera{LensModel::pinhole, // of test_info.yaml beside the photographs, which are undistorted
                             {1056, 792},        329.8729619143081, 332.94611303946357, 528, 396, {}};
    double const half = 0.065 / 2;
    std::array<glm::dvec3, 4> const corners{
        {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}}};
    int photographs = 0, ambiguous = 0;
    double ours_off = 0, theirs_off = 0, most_rms = 0, most_reference_px = 0;
    std::optional<gi::RigidPose> last, last_reference;
    nlohmann::json const all = read(file);
    for (int turn = -70; turn <= 70; turn += 10) {
        nlohmann::json const& tag = all["images"][fmt::format("test_image_rotation_{}.png", turn)][0];
        Sighting s;
        for (std::size_t i = 0; i < 4; ++i) {
            auto const& c = tag["corners_lb_rb_rt_lt"][i];
            s.points.push_back({corners[i], {c[0], c[1]}, 76, 0.3});
        }
        PoseEstimate const e = estimate_pose(s, camera, last);
        ASSERT_TRUE(e.found()) << turn;
        gi::RigidPose const reference = inverse(pose_of(vec3(tag["rvec"]), vec3(tag["tvec_m"])));
        if (last) { // the tag was turned by 10 degrees, by hand
            ours_off += std::abs(angle_between_deg(last->rotation, e.world_from_camera.rotation) - 10) / 14;
            theirs_off += std::abs(angle_between_deg(last_reference->rotation, reference.rotation) - 10) / 14;
        }
        last = e.world_from_camera;
        last_reference = reference;
        ++photographs;
        ambiguous += e.ambiguous;
        most_rms = std::max(most_rms, e.rms_px);
        double sum = 0;
        for (SightedPoint const& p : s.points) {
            glm::dvec2 const miss = *project(camera, inverse(reference) * p.world_m) - p.pixel;
            sum += glm::dot(miss, miss) / 4;
        }
        most_reference_px = std::max(most_reference_px, std::sqrt(sum));
        EXPECT_LT(e.rms_px, std::sqrt(sum) + 1e-9) << turn;
    }
    fmt::print("{} photographs of a tag of 65 mm, turned by 10 deg each: off by {:.2f} deg on the mean (OpenCV's "
               "unrefined IPPE {:.2f}), rms at most {:.2f} px (OpenCV's {:.2f}), {} ambiguous\n",
               photographs, ours_off, theirs_off, most_rms, most_reference_px, ambiguous);
    EXPECT_LT(ours_off, 3);
}

} // namespace
} // namespace ar::test
