// lightwell ar calibrate and response: from a board and a bracket with known truth to a calibration file.

#include "ar/calibration/calibration_file.h"
#include "ar/calibration/lens.h"
#include "ar/markers/marker_map_file.h"
#include "tests/ar_markers/drawn_view.h"
#include "tests/viewer/run_program.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace viewer::test {
namespace {

gi::RigidPose view_pose(cv::RNG& rng, glm::dvec3 middle)
{
    double const distance = rng.uniform(0.34, 0.55);
    double const a = rng.uniform(-0.6, 0.6), b = rng.uniform(-0.6, 0.6);
    glm::dvec3 const eye = middle + distance * glm::normalize(glm::dvec3(std::sin(a), std::sin(b), std::cos(a)));
    glm::dvec3 const target = middle + glm::dvec3(rng.uniform(-0.1, 0.1), rng.uniform(-0.08, 0.08), 0);
    gi::RigidPose const p = ar::test::looking(eye, target);
    return {p.position, glm::normalize(p.rotation * glm::angleAxis(rng.uniform(-0.4, 0.4), glm::dvec3(0, 0, 1)))};
}

void draw_views(std::filesystem::path const& folder, ar::MarkerMap const& map, ar::CameraModel const& camera,
                int count)
{
    std::filesystem::create_directory(folder);
    ar::test::ViewSettings settings;
    settings.rays = 3;
    settings.dots_per_m = 3000;
    ar::test::DrawnWorld const world(map, camera, settings);
    cv::RNG rng(7);
    for (int i = 0; i < count; ++i)
        cv::imwrite((folder / fmt::format("{}.png", i)).string(),
                    world.picture(view_pose(rng, {0.14, 0.1, 0}), std::uint64_t(i)));
}

TEST(ArCalibrate, FindsADrawnLensByTheBoardThatItPrinted)
{
    TemporaryFolder const folder;
    run_well("ar board --squares 7x5 --square 0.04 --marker 0.03 --out b.svg --markers m.yaml --upright",
             folder.path());
    ar::CameraModel const truth{ar::LensModel::radial_tangential,
                                {480, 360},
                                394,
                                396,
                                238.5,
                                182.25,
                                {-0.28, 0.09, 0.001, -0.0007, -0.01, 0, 0, 0}};
    draw_views(folder / "views", ar::read_marker_map(folder / "m.yaml"), truth, 20);
    Outcome const o = run_well(
        "ar calibrate views --markers m.yaml --lens radial_tangential --out camera.yaml --report report.html",
        folder.path());
    fmt::print("{}", o.out);
    ar::Calibration const c = ar::read_calibration(folder / "camera.yaml");
    auto const is = parameters_of(c.camera), was = parameters_of(truth);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(is[i] / was[i], 1, 0.005) << i;
    EXPECT_LT(c.rms_px, 0.25);
    EXPECT_EQ(c.covariance.rows, 9);
    EXPECT_NE(o.out.find("coverage: "), std::string::npos);
    EXPECT_NE(o.out.find("frame 0 "), std::string::npos) << "RMS view by view";
    EXPECT_NE(file_text(folder / "report.html").find("</html>"), std::string::npos);

    // The lens chosen by itself may be another one, but sees the same.
    Outcome const chosen = run_well("ar calibrate views --squares 7x5 --out chosen.yaml --every 2", folder.path());
    EXPECT_NE(chosen.out.find("lens: "), std::string::npos);
    ar::CameraModel const other = ar::read_calibration(folder / "chosen.yaml").camera;
    EXPECT_NE(other.lens, ar::LensModel::pinhole);
    EXPECT_NEAR(other.fx / truth.fx, 1, 0.01);
}

TEST(ArCalibrate, FindsTheCameraOfTheViewsOfTheBoard)
{
    TemporaryFolder const folder;
    run_well("ar board --squares 8x6 --square 0.03 --marker 0.022 --out b.svg --markers m.yaml --views views",
             folder.path());
    run_well("ar calibrate views --markers m.yaml --lens radial_tangential --out camera.yaml", folder.path());
    ar::Calibration const found = ar::read_calibration(folder / "camera.yaml");
    auto const is = parameters_of(found.camera);
    auto const was = parameters_of(ar::read_calibration(folder / "views/truth.yaml").camera);
    for (std::size_t i = 0; i < 4; ++i) {
        fmt::print("{:+.3f} %\n", 100 * (is[i] / was[i] - 1));
        EXPECT_NEAR(is[i] / was[i], 1, 0.005) << i;
    }
    // What was known of the sensor stays with a new lens, unless its pictures have another size.
    ar::Calibration known = found;
    known.noise = ar::NoiseModel{0.002, 3e-5};
    ar::write_calibration(folder / "camera.yaml", known);
    run_well("ar calibrate views --markers m.yaml --lens pinhole --out camera.yaml", folder.path());
    ar::Calibration const again_found = ar::read_calibration(folder / "camera.yaml");
    EXPECT_EQ(again_found.camera.lens, ar::LensModel::pinhole);
    ASSERT_TRUE(again_found.noise);
    EXPECT_DOUBLE_EQ(again_found.noise->read, 0.002);
    known.camera = ar::scaled(known.camera, 2 * known.camera.size_px);
    ar::write_calibration(folder / "camera.yaml", known);
    Outcome const other =
        run_well("ar calibrate views --markers m.yaml --lens pinhole --out camera.yaml", folder.path());
    EXPECT_NE(other.out.find("left out"), std::string::npos) << other.out;
    EXPECT_FALSE(ar::read_calibration(folder / "camera.yaml").noise);
    // In a session the board has to be held still, unless it is said that it is.
    run_well("ar record views --rate 200 --out session", folder.path());
    Outcome const moving = run("ar calibrate session --markers m.yaml --out moving.yaml", folder.path());
    EXPECT_EQ(moving.code, 1) << moving.out;
    EXPECT_NE(moving.out.find("20 show it moving"), std::string::npos) << moving.out;
    run_well("ar calibrate session --markers m.yaml --stills --every 3 --lens pinhole --out stills.yaml",
             folder.path());
    Outcome const again = run("ar board --squares 8x6 --out b.svg --views views", folder.path());
    EXPECT_EQ(again.code, 2);
    EXPECT_NE(again.err.find("it exists"), std::string::npos) << again.err;
}

TEST(ArCalibrate, SaysWhichViewsAreMissing)
{
    TemporaryFolder const folder;
    run_well("ar board --squares 7x5 --out b.svg --markers m.yaml --upright", folder.path());
    draw_views(folder / "views", ar::read_marker_map(folder / "m.yaml"),
               {ar::LensModel::pinhole, {320, 240}, 263, 263, 159.5, 119.5, {}}, 2);
    Outcome const o = run("ar calibrate views --markers m.yaml --out camera.yaml", folder.path());
    EXPECT_EQ(o.code, 1);
    EXPECT_NE(o.err.find("are not enough (2 of 4) show the board in the "), std::string::npos) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "camera.yaml"));
}

TEST(ArCalibrate, RefusesABoardThatIsNotTheOneDescribed)
{
    TemporaryFolder const folder;
    draw_views(folder / "odd", {{}, {{7, 5, 0.04, 0.03, "DICT_4X4_50", 0, false, {}}}, {}},
               {ar::LensModel::pinhole, {480, 360}, 394, 394, 239.5, 179.5, {}}, 8);
    draw_views(folder / "legacy", {{}, {{8, 6, 0.03, 0.022, "DICT_4X4_50", 0, true, {}}}, {}},
               {ar::LensModel::pinhole, {480, 360}, 394, 394, 239.5, 179.5, {}}, 8);
    for (std::string const command :
         {"odd --squares 5x7 --square 0.04 --marker 0.03", "legacy --squares 8x6 --square 0.03 --marker 0.022",
          "legacy --squares 6x8 --square 0.03 --marker 0.022", "odd --squares 7x5 --square 0.04 --marker 0.02"}) {
        Outcome const o = run("ar calibrate " + command + " --out c.yaml --report r.html", folder.path());
        EXPECT_EQ(o.code, 1) << command << o.out << o.err;
        EXPECT_NE(o.err.find("exchange the numbers of --squares"), std::string::npos) << command << o.err;
        EXPECT_NE(o.err.find("--legacy-pattern"), std::string::npos) << command << o.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "c.yaml")) << command;
        EXPECT_FALSE(std::filesystem::exists(folder / "r.html")) << command;
    }
    run_well("ar calibrate legacy --squares 8x6 --square 0.03 --marker 0.022 --legacy-pattern --lens pinhole "
             "--out c.yaml",
             folder.path());
    EXPECT_NEAR(ar::read_calibration(folder / "c.yaml").camera.fx / 394, 1, 0.02);
}

/// Two sizes of squares in one set of views: the picture of each is right in itself.
TEST(ArCalibrate, RefusesWhatNoLensExplains)
{
    TemporaryFolder const folder;
    std::filesystem::create_directory(folder / "views");
    cv::RNG rng(3);
    for (int i = 0; i < 8; ++i) {
        cv::Mat picture(360, 480, CV_8UC1, cv::Scalar(230));
        // Squares of a chessboard along a sine: no plane in perspective, nor the same one twice.
        double const phase = rng.uniform(0., 6.), tilt = rng.uniform(-0.2, 0.2), x0 = rng.uniform(60., 100.);
        for (int y = 0; y < 360; ++y)
            for (int x = 0; x < 480; ++x) {
                double const u = (x - x0 + 14 * std::sin(0.02 * y + phase)) / 36,
                             v = (y - 60 + tilt * x + 14 * std::sin(0.025 * x + phase)) / 36;
                if (u > 0 && v > 0 && u < 8 && v < 6 && (int(u) + int(v)) % 2 == 0)
                    picture.at<std::uint8_t>(y, x) = 20;
            }
        cv::GaussianBlur(picture, picture, {}, 0.8);
        cv::imwrite((folder / fmt::format("views/{}.png", i)).string(), picture);
    }
    Outcome const o = run(
        "ar calibrate views --chessboard 7x5 --square 0.03 --lens radial_tangential --out c.yaml", folder.path());
    EXPECT_EQ(o.code, 1) << o.out << o.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "c.yaml"));
}

TEST(ArResponse, IsThatOfTheBracket)
{
    TemporaryFolder const folder;
    ar::Calibration calibration;
    calibration.camera = {ar::LensModel::pinhole, {160, 120}, 150, 150, 79.5, 59.5, {}};
    ar::write_calibration(folder / "camera.yaml", calibration);
    for (int k = 0; k < 4; ++k) { // bytes are light to the power of 1/1.8
        cv::Mat picture(120, 160, CV_8UC3);
        for (int y = 0; y < 120; ++y)
            for (int x = 0; x < 160; ++x) {
                double const light = 4 * std::exp(-(x + y * 0.2) / 30) / (1 << k);
                picture.at<cv::Vec3b>(y, x) =
                    cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(255 * std::pow(light, 1 / 1.8)));
            }
        cv::imwrite((folder / fmt::format("{}.png", k)).string(), picture);
    }
    Outcome const o =
        run_well("ar response 0.png 1.png 2.png 3.png --exposures 1/30,1/60,1/120,1/240 --calibration camera.yaml",
                 folder.path());
    auto const photometry = ar::read_calibration(folder / "camera.yaml").photometry;
    ASSERT_TRUE(photometry);
    for (std::size_t const byte : {40u, 128u, 220u})
        EXPECT_NEAR(photometry->unit_of_byte[1][byte] / std::pow(double(byte) / 255, 1.8), 1, 0.03) << byte;
    EXPECT_NE(o.out.find("camera.yaml"), std::string::npos);
    Outcome const bad = run("ar response 0.png 1.png --exposures 1/30 --calibration camera.yaml", folder.path());
    EXPECT_EQ(bad.code, 2);
    EXPECT_NE(bad.err.find("2 pictures and 1 exposures"), std::string::npos) << bad.err;
}

} // namespace
} // namespace viewer::test
