// Light of a real place: a captured map, pictures made from it by others, and what this room makes of them.

#include "ar/camera/photometry.h"
#include "ar/light/lamps.h"
#include "ar/light/live_probe.h"
#include "ar/light/map_file.h"
#include "ar/light/mirror_ball.h"
#include "gi/core/rotation.h"
#include "tests/ar_light/irradiance_maps.h"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

namespace fs = std::filesystem;

fs::path const kData = fs::path(LIGHTWELL_SOURCE_DIR) / "../shared/data";

bool is_missing(fs::path const& file) { return !fs::exists(kData / file); }

double angle_deg(glm::dvec3 a, glm::dvec3 b)
{
    return glm::degrees(std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)));
}

TEST(Workshop, FromItsOrthographicMirrorBall)
{
    if (is_missing("envmaps/autoshop_01_mirrorball_ortho_512.exr")) GTEST_SKIP() << "SKIPPED: no shared data";
    cv::Mat const truth = read_map(kData / "envmaps/autoshop_01_1k.hdr");
    cv::Mat const picture = read_radiance(kData / "envmaps/autoshop_01_mirrorball_ortho_512.exr");
    // Orthographic is what a ball is from very far away: it fills the picture, seen along -z with y up.
    BallSight const ball{{0, 0, 1}, 1e-4, 0, 0};
    CameraModel const camera{
        LensModel::pinhole, {512, 512}, 256 / std::tan(1e-4), 256 / std::tan(1e-4), 255.5, 255.5, {}};
    BallSettings settings;
    settings.camera_half_angle_rad = 1e-3;
    PartialMap const seen = unwrap_ball(picture, camera, {0, 1, 0, 0}, ball, settings);
    FilledMap const f = filled(seen);
    double const error = relative_error2(irradiance_map(f.radiance), irradiance_map(truth));
    auto const true_lamps = split_lamps(truth).lamps, lamps = split_lamps(f.radiance).lamps;
    ASSERT_FALSE(true_lamps.empty());
    ASSERT_FALSE(lamps.empty());
    double nearest = 180;
    for (Lamp const& l : lamps) nearest = std::min(nearest, angle_deg(l.direction, true_lamps[0].direction));
    fmt::print("workshop by its mirror ball: {:.1f} % covered, relMSE of irradiance {:.1e}, strongest lamp {:.2f} "
               "deg off, "
               "{} of {} lamps\n",
               100 * covered_share(seen), error, nearest, lamps.size(), true_lamps.size());
    EXPECT_LT(error, 0.02);
    EXPECT_LT(nearest, 1);
}

TEST(Maps, KeepTheirLightWithoutTheirLamps)
{
    if (is_missing("envmaps/autoshop_01_1k.hdr")) GTEST_SKIP() << "SKIPPED: no shared data";
    for (char const* name : {"autoshop_01_1k", "kloppenheim_05_1k", "hilly_terrain_01_1k",
                             "st_peters_square_night_1k", "dancing_hall_1k", "dresden_square_1k"}) {
        if (is_missing(fmt::format("envmaps/{}.hdr", name))) continue;
        cv::Mat const map = read_map(kData / fmt::format("envmaps/{}.hdr", name));
        SplitMap const s = split_lamps(map);
        cv::Vec3d sum = integral(s.rest);
        for (Lamp const& l : s.lamps) sum += l.irradiance;
        cv::Vec3d const whole = integral(map);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / whole[c], 1, 1e-4) << name;
        double const error = relative_error2(irradiance_map(with_lamps(s.rest, s.lamps)), irradiance_map(map));
        EXPECT_LT(error, 1e-3) << name;
        fmt::print("{}: {} lamps hold {:.0f} % of the light; left in the map: {} faint, {} large, {} too many",
                   name, s.lamps.size(), 100 * s.lamp_share, s.too_faint, s.too_large, s.too_many);
        if (!s.lamps.empty())
            fmt::print("; strongest at {:.1f} deg above the horizon, {:.2f} deg across",
                       glm::degrees(std::asin(s.lamps[0].direction.y)),
                       2 * glm::degrees(s.lamps[0].half_angle_rad));
        fmt::print("\n");
    }
}

struct View {
    std::string picture; ///< linear
    CameraModel camera;
    glm::dquat world_from_camera;
};

/// Of data/ar/probe_views. Its cameras look along -z with y up and its pixels' centres are at halves.
std::vector<View> views()
{
    std::ifstream in(kData / "ar/probe_views/probe_views.json");
    std::vector<View> all;
    nlohmann::json const file = nlohmann::json::parse(in);
    for (auto const& v : file["views"]) {
        glm::dmat3 m;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                m[c][r] = v["camera_to_world_rotation_rowmajor"][std::size_t(r)][std::size_t(c)];
        glm::dquat const half_turn(0, 1, 0, 0);
        all.push_back({v["linear"],
                       {LensModel::pinhole,
                        {v["width"], v["height"]},
                        v["fx"],
                        v["fy"],
                        double(v["cx"]) - 0.5,
                        double(v["cy"]) - 0.5,
                        {}},
                       glm::normalize(glm::quat_cast(m)) * half_turn});
    }
    return all;
}

TEST(Workshop, LiveProbeFromThreeViews)
{
    if (is_missing("ar/probe_views/autoshop_view2_linear.exr")) GTEST_SKIP() << "SKIPPED: no shared data";
    cv::Mat const truth = resampled(read_map(kData / "envmaps/autoshop_01_1k.hdr"), {64, 32});
    cv::Mat const true_irradiance = irradiance_map(truth);
    cv::Mat dim;
    cv::multiply(truth, cv::Scalar(0.4, 0.5, 0.6), dim);
    cv::Mat const grey(32, 64, CV_32FC3, cv::mean(truth));
    for (bool const linear : {true, false})
        for (auto const& [name, prior] : {std::pair("none", cv::Mat()), std::pair("dimmed and bluer", dim)}) {
            LiveProbe probe(prior);
            ProbeUpdate u;
            double t = 0, off = 0;
            for (View const& v : views()) {
                glm::dquat const q = v.world_from_camera;
                CameraModel const& camera = v.camera;
                cv::Mat const exr = read_radiance(kData / "ar/probe_views" / v.picture);
                cv::Mat radiance = exr, clipped;
                if (!linear) {
                    cv::Mat const rgb = bytes_of(exr, srgb_photometry());
                    radiance = radiance_of(rgb, srgb_photometry());
                    clipped = is_clipped(rgb);
                }
                u = probe.update(radiance, clipped, camera, q, t += 0.5);
                for (int i = 0; i < 10; ++i) u = probe.update(radiance, clipped, camera, q, t += 0.033);
                if (linear && prior.empty()) { // the views are where we think: they show what the map shows
                    cv::Mat const fine = read_map(kData / "envmaps/autoshop_01_1k.hdr");
                    double sum = 0, all = 0;
                    for (int y = 4; y < 480; y += 8)
                        for (int x = 4; x < 640; x += 8) {
                            cv::Vec3f const m = sample(fine, q * *direction_of(camera, {x, y}));
                            sum += cv::norm(m - exr.at<cv::Vec3f>(y, x), cv::NORM_L1);
                            all += cv::norm(m, cv::NORM_L1);
                        }
                    off = std::max(off, sum / all);
                }
            }
            if (off > 0) fmt::print("the views are the map's to {:.2f} %\n", 100 * off);
            EXPECT_LT(off, 0.02);
            double const error = relative_error2(irradiance_map(probe.map()), true_irradiance);
            double const before = relative_error2(irradiance_map(prior.empty() ? grey : prior), true_irradiance);
            cv::Vec3d const up = irradiance(harmonics_of(probe.map()), {0, 1, 0});
            cv::Vec3d const true_up = irradiance(harmonics_of(truth), {0, 1, 0});
            fmt::print(
                "live probe, three {} views, prior {}: {:.0f} % known, relMSE of irradiance {:.1e} (prior alone "
                "{:.1e}); upward {:.3f} {:.3f} {:.3f}, truth {:.3f} {:.3f} {:.3f}\n",
                linear ? "linear" : "sRGB", name, 100 * u.known_share, error, before, up[0], up[1], up[2],
                true_up[0], true_up[1], true_up[2]);
            EXPECT_LT(error, prior.empty() ? 0.5 : linear ? 0.02 : 0.1);
            if (!prior.empty()) {
                EXPECT_LT(error, 0.5 * before);
            }
        }
}

} // namespace
} // namespace ar::test
