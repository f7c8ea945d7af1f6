#include "ar/calibration/lens_choice.h"

#include "gi/core/error.h"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

namespace ar::test {
namespace {

CameraModel camera(LensModel lens)
{
    CameraModel c{lens, {640, 480}, 525, 530, 318.5, 243.25, {}};
    if (lens == LensModel::radial_tangential) c.distortion = {-0.28, 0.09, 0.001, -0.0007, -0.01};
    if (lens == LensModel::rational) c.distortion = {0.4, 0.1, 0.0005, -0.0003, 0.02, 0.7, 0.2, 0.03};
    if (lens == LensModel::fisheye) {
        c.fx = c.fy = 300;
        c.distortion = {0.03, -0.01, 0.004, -0.001};
    }
    return c;
}

/// A board of 9 x 6 corners seen from all over, with noise.
std::vector<BoardView> views_of(CameraModel const& c, double noise_px, int count = 20)
{
    cv::RNG rng(7);
    std::vector<BoardView> views;
    while (int(views.size()) < count) {
        BoardView v;
        v.name = fmt::format("view {}", views.size());
        double const z = rng.uniform(0.3, 0.55) * (c.lens == LensModel::fisheye ? 0.6 : 1);
        double const wide = 0.5 * c.size_px.x / c.fx, high = 0.5 * c.size_px.y / c.fy;
        cv::Vec3d const turn(rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6), rng.uniform(-0.5, 0.5));
        gi::RigidPose const p =
            pose_of(turn, {rng.uniform(-wide, wide) * z * 0.6, rng.uniform(-high, high) * z * 0.6, z});
        gi::RigidPose const centred = p * gi::RigidPose{{-0.12, -0.075, 0}, {1, 0, 0, 0}};
        for (int i = 0; i < 54; ++i) {
            glm::dvec3 const m(0.03 * (i % 9), 0.03 * (i / 9), 0);
            auto const px = project(c, centred * m);
            if (!px || px->x < 0 || px->y < 0 || px->x > 639 || px->y > 479) continue;
            v.board_m.push_back(m);
            v.pixels.push_back(*px + glm::dvec2(rng.gaussian(noise_px), rng.gaussian(noise_px)));
        }
        if (v.pixels.size() > 12) views.push_back(v);
    }
    return views;
}

class OfLens : public testing::TestWithParam<LensModel> {};
INSTANTIATE_TEST_SUITE_P(All, OfLens,
                         testing::Values(LensModel::pinhole, LensModel::radial_tangential, LensModel::rational,
                                         LensModel::fisheye),
                         [](auto const& p) { return name_of(p.param); });

TEST_P(OfLens, IsFoundWithinItsStandardDeviations)
{
    CameraModel const truth = camera(GetParam());
    LensCalibration const c = calibrate_lens(views_of(truth, 0.1), truth.size_px, GetParam());
    fmt::print("{}: fx {:.3f} +- {:.3f} (truth {}), rms {:.4f} px\n", name_of(GetParam()), c.camera.fx,
               c.standard_deviations[0], truth.fx, c.rms_px);
    EXPECT_NEAR(c.rms_px, 0.1 * std::sqrt(2.), 0.01);
    auto const is = parameters_of(c.camera), was = parameters_of(truth);
    for (std::size_t i = 0; i < (GetParam() == LensModel::rational ? 4 : is.size()); ++i)
        EXPECT_LT(std::abs(is[i] - was[i]), 4 * c.standard_deviations[i]) << c.parameters[i];
    EXPECT_EQ(c.used_views(), 20);
}

TEST(Lens, StandardDeviationsAreThoseOfOpenCv)
{
    CameraModel const truth = camera(LensModel::radial_tangential);
    auto const views = views_of(truth, 0.2);
    LensCalibration const c = calibrate_lens(views, truth.size_px, truth.lens);
    std::vector<std::vector<cv::Point3f>> board;
    std::vector<std::vector<cv::Point2f>> pixels;
    for (auto const& v : views) {
        board.emplace_back();
        pixels.emplace_back();
        for (auto const& p : v.board_m) board.back().emplace_back(float(p.x), float(p.y), 0.f);
        for (auto const& p : v.pixels) pixels.back().emplace_back(float(p.x), float(p.y));
    }
    cv::Mat k, d, inside, outside, each;
    std::vector<cv::Mat> r, t;
    double const opencv_rms = cv::calibrateCamera(board, pixels, {640, 480}, k, d, r, t, inside, outside, each);
    EXPECT_NEAR(c.rms_px, opencv_rms, 1e-3);
    // OpenCV 4.6 divides by points less parameters, but a point is two measurements; 4.10 counts them.
    double points = 0;
    for (auto const& v : views) points += double(v.pixels.size());
    double const unknown = 9 + 6. * double(views.size());
    double const too_large = CV_VERSION_MINOR >= 10 ? 1 : std::sqrt((2 * points - unknown) / (points - unknown));
    for (int i = 0; i < 9; ++i)
        EXPECT_NEAR(too_large * c.standard_deviations[std::size_t(i)] / inside.at<double>(i), 1, 0.01)
            << c.parameters[std::size_t(i)];
}

TEST(Lens, NamesViewsThatAreWrong)
{
    CameraModel const truth = camera(LensModel::radial_tangential);
    auto views = views_of(truth, 0.1);
    for (std::size_t i = 0; i < views[4].pixels.size(); i += 3) views[4].pixels[i].x += 6; // a bent board
    views[11].pixels.resize(4);
    views[11].board_m.resize(4);
    LensCalibration const c = calibrate_lens(views, truth.size_px, truth.lens);
    EXPECT_EQ(c.used_views(), 18);
    EXPECT_FALSE(c.views[4].used);
    EXPECT_NE(c.views[4].why.find("times the median"), std::string::npos);
    EXPECT_GT(c.views[4].rms_px, 1);
    EXPECT_NE(c.views[11].why.find("4 points"), std::string::npos);
    EXPECT_NEAR(c.camera.fx, truth.fx, 0.002 * truth.fx);
    EXPECT_THROW(calibrate_lens({views[0], views[1]}, truth.size_px, truth.lens), gi::InputError);
}

TEST(Lens, WarnsOfPoorViews)
{
    CameraModel const truth = camera(LensModel::radial_tangential);
    std::vector<BoardView> views;
    for (int i = 0; i < 4; ++i) { // all in the middle, hardly tilted
        BoardView v;
        for (int k = 0; k < 54; ++k) {
            glm::dvec3 const m(0.01 * (k % 9), 0.01 * (k / 9), 0);
            gi::RigidPose const p = pose_of({0.04 * i, -0.03 * i, 0}, {-0.04 + 0.003 * i, -0.03, 0.5});
            v.board_m.push_back(m);
            v.pixels.push_back(*project(truth, p * m) +
                               glm::dvec2(0.05 * std::sin(7. * k + i), 0.05 * std::cos(5. * k)));
        }
        views.push_back(v);
    }
    LensCalibration const c = calibrate_lens(views, truth.size_px, LensModel::pinhole);
    std::string all;
    for (auto const& w : c.warnings) all += w + "\n";
    EXPECT_NE(all.find("only 4 views"), std::string::npos) << all;
    EXPECT_NE(all.find("% of the picture"), std::string::npos) << all;
    EXPECT_NE(all.find("tilted"), std::string::npos) << all;
    EXPECT_NE(all.find("same distance"), std::string::npos) << all;
}

TEST_P(OfLens, IsChosenByViewsLeftOut)
{
    CameraModel const truth = camera(GetParam());
    LensChoice const choice = choose_lens(views_of(truth, 0.1, 10), truth.size_px);
    for (auto const& t : choice.trials)
        fmt::print("{} by {}: fitted {:.4f} px, validated {:.4f} px {}\n", name_of(truth.lens), name_of(t.lens),
                   t.fitted_rms_px, t.validated_rms_px, t.failed);
    fmt::print("chosen: {}\n", choice.why);
    auto const of = [&](LensModel lens) {
        for (auto const& t : choice.trials)
            if (t.lens == lens) return t.validated_rms_px;
        return 1e9;
    };
    EXPECT_LT(of(choice.chosen), 0.165);
    EXPECT_LE(coefficient_count(choice.chosen), std::max(0, coefficient_count(truth.lens)));
}

} // namespace
} // namespace ar::test
