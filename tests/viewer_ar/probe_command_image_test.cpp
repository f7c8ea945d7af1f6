// lightwell ar probe: brackets of a traced mirror ball beside a board, from two sides,
// to the light that was there.

#include "ar/calibration/calibration_file.h"
#include "ar/light/lamps.h"
#include "ar/light/lat_long.h"
#include "ar/light/map_file.h"
#include "ar/markers/marker_map_file.h"
#include "tests/ar_light/environments.h"
#include "tests/ar_light/irradiance_maps.h"
#include "tests/ar_markers/drawn_view.h"
#include "tests/viewer/run_program.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/imgcodecs.hpp>

namespace viewer::test {
namespace {

constexpr double kRadius = 0.08, kReflectivity = 0.6;
constexpr glm::dvec3 kBall{0.14, 0.09, -0.32};
std::vector<ar::test::Disc> const kDiscs{{{0.3, 0.9, 0.2}, 0.06, 60}, {{-1, 0.4, 0.4}, 0.05, 60}};

ar::Calibration camera()
{
    ar::Calibration c;
    c.camera = {ar::LensModel::radial_tangential,     {480, 360}, 450, 451, 237, 182,
                {-0.1, 0.03, 5e-4, -4e-4, 0, 0, 0, 0}};
    c.photometry = ar::srgb_photometry();
    c.photometry->reference.time_s = 1. / 30;
    return c;
}

/// The board and a bright backdrop, before them the ball; 2 x 2 rays per pixel of it.
cv::Mat traced(ar::test::DrawnWorld const& world, gi::RigidPose const& pose, ar::test::Environment const& light,
               cv::Vec3d lit)
{
    cv::Mat picture;
    cv::cvtColor(world.light(pose), picture, cv::COLOR_GRAY2RGB);
    picture = picture.mul(cv::Scalar(lit[0], lit[1], lit[2]));
    glm::dvec3 const eye = pose.position - kBall;
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            cv::Vec3d sum(0, 0, 0);
            for (int k = 0; k < 4; ++k) {
                glm::dvec2 const p(x - 0.25 + 0.5 * (k % 2), y - 0.25 + 0.5 * (k / 2));
                glm::dvec3 const d = pose.rotation * *direction_of(world.camera(), p);
                double const b = glm::dot(eye, d), c = glm::dot(eye, eye) - kRadius * kRadius;
                if (b * b > c) {
                    glm::dvec3 const at = eye + (-b - std::sqrt(b * b - c)) * d;
                    sum += kReflectivity * light(glm::reflect(d, at / kRadius));
                } else {
                    sum += picture.at<cv::Vec3f>(y, x);
                }
            }
            picture.at<cv::Vec3f>(y, x) = cv::Vec3f(sum / 4);
        }
    return picture;
}

/// a0.png, a1.png, a2.png, b0.png, ...
/// @param lit  colour of the light on the board, relative to that of its drawing
void write_brackets(TemporaryFolder const& folder, ar::test::Environment const& light, cv::Vec3d lit = {1, 1, 1})
{
    ar::test::ViewSettings settings;
    settings.rays = 2;
    settings.background = 0.85;
    ar::Calibration const c = camera();
    ar::test::DrawnWorld const world(ar::read_marker_map(folder / "m.yaml"), c.camera, settings);
    for (int side = 0; side < 2; ++side) {
        double const turn = side == 0 ? -0.785 : 0.785;
        glm::dvec3 const target{0.14, 0.03, -0.2};
        cv::Mat const radiance = traced(
            world,
            ar::test::looking(target + glm::dvec3(0.5 * std::sin(turn), 0.45, 0.5 * std::cos(turn)), target),
            light, lit);
        for (int k = 0; k < 3; ++k) {
            ar::Exposure e;
            e.time_s = 1. / (30 << 3 * k);
            cv::Mat bytes = ar::bytes_of(radiance, *c.photometry, e);
            cv::cvtColor(bytes, bytes, cv::COLOR_RGB2BGR);
            cv::imwrite((folder / fmt::format("{}{}.png", side == 0 ? 'a' : 'b', k)).string(), bytes);
        }
    }
}

double nearest_deg(std::vector<ar::Lamp> const& lamps, glm::dvec3 direction)
{
    double best = 180;
    for (ar::Lamp const& l : lamps)
        best = std::min(best, glm::degrees(std::acos(std::min(
                                  1.0, glm::dot(glm::normalize(l.direction), glm::normalize(direction))))));
    return best;
}

TEST(ArProbe, GivesBackTheLightInTheWorldOfTheMarkers)
{
    TemporaryFolder const folder;
    run_well("ar board --squares 7x5 --square 0.04 --marker 0.03 --out b.svg --markers m.yaml", folder.path());
    ar::write_calibration(folder / "camera.yaml", camera());
    auto const light = ar::test::with_discs(ar::test::kRoom, kDiscs);
    write_brackets(folder, light);
    cv::Mat const truth =
        ar::test::irradiance_map(ar::test::drawn({256, 128}, light), {16, 8}, ar::test::IrradianceBy::exact_sum);
    std::string const rest =
        " --calibration camera.yaml --markers m.yaml --ball-radius 0.08 --exposures 1/30,1/240,1/1920 --size 256";
    for (std::string const ball : {"", " --ball 0.145,0.085,-0.325"}) {
        Outcome const o = run_well("ar probe a0.png a1.png a2.png b0.png b1.png b2.png --out p.exr" + rest + ball,
                                   folder.path());
        fmt::print("{}", o.out);
        cv::Mat const map = ar::read_map(folder / "p.exr");
        ASSERT_EQ(map.size(), cv::Size(256, 128));
        double const error = ar::test::relative_error2(
            ar::test::irradiance_map(map, {16, 8}, ar::test::IrradianceBy::exact_sum), truth);
        auto const lamps = ar::split_lamps(map).lamps;
        fmt::print("relMSE of irradiance {:.1e}\n", error);
        EXPECT_LT(error, 0.02);
        EXPECT_EQ(lamps.size(), kDiscs.size());
        for (auto const& d : kDiscs) EXPECT_LT(nearest_deg(lamps, d.direction), 1);
        EXPECT_NE(o.out.find("2 lights with"), std::string::npos);
    }
    Outcome const one = run_well("ar probe a0.png a1.png a2.png --out one.exr" + rest, folder.path());
    EXPECT_NE(one.out.find("% filled in from neighbours"), std::string::npos);
    Outcome const behind = run("ar probe a0.png a1.png a2.png --out x.exr --ball 0.1,3,3" + rest, folder.path());
    EXPECT_EQ(behind.code, 2);
    EXPECT_NE(behind.err.find("no ball was found in a0.png (--ball 0.1,3,3 (it is not in"), std::string::npos)
        << behind.err;
    Outcome const elsewhere =
        run("ar probe a0.png a1.png a2.png --out x.exr --ball -0.2,0.09,-0.3" + rest, folder.path());
    EXPECT_EQ(elsewhere.code, 2) << elsewhere.out;
    EXPECT_FALSE(std::filesystem::exists(folder / "x.exr"));
    Outcome const odd = run("ar probe a0.png a1.png --out odd.exr" + rest, folder.path());
    EXPECT_EQ(odd.code, 2);
    EXPECT_NE(odd.err.find("2 pictures and 3 exposures"), std::string::npos) << odd.err;
}

TEST(ArProbe, EstimatesAClippedSunByThePaperBesideTheBall)
{
    TemporaryFolder const folder;
    run_well("ar board --squares 7x5 --square 0.04 --marker 0.03 --out b.svg --markers m.yaml", folder.path());
    ar::write_calibration(folder / "camera.yaml", camera());
    // Red, as the evening's; the shortest exposure is white at 64 / 0.6.
    ar::test::Environment const light = [](glm::dvec3 d) {
        cv::Vec3d v = ar::test::kRoom(d);
        if (glm::dot(glm::normalize(glm::dvec3(0.4, 0.8, 0.3)), d) > std::cos(0.03)) v += cv::Vec3d(900, 700, 450);
        return v;
    };
    cv::Mat const truth = ar::test::drawn({512, 256}, light);
    cv::Vec3d const up = ar::irradiance_exact(truth, {0, 1, 0});
    write_brackets(folder, light, up / std::numbers::pi); // white paper: an albedo of 0.8
    std::string const rest =
        "ar probe a0.png a1.png a2.png b0.png b1.png b2.png --calibration camera.yaml --markers "
        "m.yaml --ball-radius 0.08 --ball 0.14,0.09,-0.32 --exposures 1/30,1/240,1/1920 --size 256";
    Outcome const before = run_well(rest + " --out p.exr --stats p.json", folder.path());
    Outcome const after = run_well(rest + " --paper-albedo 0.8 --out q.exr --stats q.json", folder.path());
    EXPECT_NE(before.out.find("lower bound: lit by clipped light"), std::string::npos) << before.out;
    EXPECT_NE(before.out.find("not to be trusted: the power of that light"), std::string::npos) << before.out;
    EXPECT_NE(after.out.find("added from the markers' paper"), std::string::npos) << after.out;
    auto const p = nlohmann::json::parse(file_text(folder / "p.json")),
               q = nlohmann::json::parse(file_text(folder / "q.json"));
    EXPECT_GT(p["clipped"]["solid_angle_sr"], 1e-3);
    EXPECT_TRUE(p["faces"][2]["lower_bound"]);
    EXPECT_FALSE(p["faces"][3]["lower_bound"]); // the sun is above
    EXPECT_FALSE(q["faces"][2]["lower_bound"]);
    EXPECT_TRUE(q["faces"][2]["estimated"]);
    glm::dvec3 const normals[] = {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
    for (glm::dvec3 const& n : normals) {
        cv::Vec3d const t = ar::irradiance_exact(truth, n);
        cv::Vec3d const a = ar::irradiance_exact(ar::read_map(folder / "p.exr"), n),
                        b = ar::irradiance_exact(ar::read_map(folder / "q.exr"), n);
        fmt::print("clipped {:+.3f} {:+.3f} {:+.3f}, repaired {:+.3f} {:+.3f} {:+.3f}\n", a[0] / t[0] - 1,
                   a[1] / t[1] - 1, a[2] / t[2] - 1, b[0] / t[0] - 1, b[1] / t[1] - 1, b[2] / t[2] - 1);
        EXPECT_LT(a[0] / t[0], 0.9);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(b[c] / t[c], 1, 0.04);
    }
}

} // namespace
} // namespace viewer::test
