#include "ar/calibration/response.h"
#include "ar/calibration/sensor.h"

#include "gi/core/error.h"
#include "tests/ar_calibration/synthetic_camera.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

Bracket bracket_of(cv::Mat const& light, Photometry const& p, Noise noise, int count = 6)
{
    Bracket b;
    for (int i = 0; i < count; ++i) {
        double const time = 0.00125 * std::pow(4., i);
        b.exposures.push_back({time, 1, 0, 0});
        b.rgb.push_back(photograph(light, p, time / 0.01, noise, std::uint64_t(i)));
    }
    return b;
}

TEST(Response, IsThatOfTheCamera)
{
    Photometry const truth = film_photometry();
    ResponseFit const fit = calibrate_response(bracket_of(scene({320, 200}), truth, {1e-7, 1e-4}));
    // Up to one factor for all channels.
    double factor = 0, count = 0, sum = 0, most = 0;
    for (std::size_t i = 20; i <= 235; ++i) {
        factor += std::log(fit.photometry.unit_of_byte[1][i] / truth.unit_of_byte[1][i]);
        ++count;
    }
    factor = std::exp(factor / count);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 20; i <= 235; ++i) {
            double const e = std::log(fit.photometry.unit_of_byte[c][i] / truth.unit_of_byte[c][i] / factor);
            sum += e * e / (3 * count);
            most = std::max(most, std::abs(e));
        }
    fmt::print("response (bytes 20 to 235): {:.2f} % rms, {:.2f} % at most; disagreement {:.4f} {:.4f} {:.4f}; {} "
               "levelled\n",
               100 * std::sqrt(sum), 100 * most, fit.disagreement[0], fit.disagreement[1], fit.disagreement[2],
               fit.levelled);
    EXPECT_LT(std::sqrt(sum), 0.03);
    EXPECT_LT(most, 0.1);
    EXPECT_LT(fit.disagreement[1], 0.1);
}

TEST(Merge, IsTheLight)
{
    Photometry truth = film_photometry();
    truth.vignetting = {-0.3, 0.1, -0.05};
    cv::Mat const light = scene({320, 200});
    Bracket b = bracket_of(light, truth, {1e-7, 1e-4});
    MergeOptions const options{{1e-7, 1e-4}, 5};
    MergedRadiance const m = merge(b, truth, options);
    double sum = 0, bias = 0;
    int count = 0, honest = 0;
    for (int y = 0; y < light.rows; ++y)
        for (int x = 0; x < light.cols; ++x) {
            double const t = light.at<cv::Vec3f>(y, x)[1], v = m.radiance.at<cv::Vec3f>(y, x)[1];
            double const e = v / t - 1;
            sum += e * e;
            bias += e;
            honest += std::abs(e) < 2.5 * m.standard_deviation.at<float>(y, x) + 0.01;
            ++count;
        }
    fmt::print("merged radiance: {:.2f} % rms, bias {:+.3f} %, {:.1f} % within 2.5 sigma, {} inconsistent, {} "
               "white, {} dark\n",
               100 * std::sqrt(sum / count), 100 * bias / count, 100. * honest / count, m.inconsistent,
               m.saturated, m.dark);
    EXPECT_LT(std::sqrt(sum / count), 0.02);
    EXPECT_LT(std::abs(bias / count), 0.005);
    EXPECT_LT(m.inconsistent, count / 200);
    EXPECT_EQ(m.saturated, 0);
    // Something bright stood there in one exposure.
    cv::Mat moved = light.clone();
    moved(cv::Rect(100, 60, 30, 40)).setTo(cv::Scalar(0.6, 0.5, 0.7));
    b.rgb[3] = photograph(moved, truth, b.exposures[3].time_s / 0.01, {1e-7, 1e-4}, 3);
    MergedRadiance const other = merge(b, truth, options);
    int flagged = cv::countNonZero(other.moved(cv::Rect(100, 60, 30, 40)));
    fmt::print("moved: {} of 1200 pixels flagged, {} elsewhere\n", flagged, other.inconsistent - flagged);
    EXPECT_GT(flagged, 1100);
    EXPECT_LT(other.inconsistent - flagged, count / 200);
}

TEST(Merge, RefusesWhatIsNoBracket)
{
    Bracket b = bracket_of(scene({32, 20}), film_photometry(), {}, 3);
    EXPECT_NO_THROW(check(b));
    b.exposures[1].time_s = 0;
    EXPECT_THROW(merge(b, srgb_photometry()), gi::InputError);
    b.exposures = {{1, 1, 0, 0}, {1, 1, 0, 0}, {1, 1, 0, 0}};
    EXPECT_THROW(merge(b, srgb_photometry()), gi::InputError);
    b.exposures.pop_back();
    EXPECT_THROW(merge(b, srgb_photometry()), gi::InputError);
    EXPECT_THROW(merge({}, srgb_photometry()), gi::InputError);
    Bracket black;
    for (double t : {1., 2., 4.}) {
        black.rgb.emplace_back(20, 20, CV_8UC3, cv::Scalar::all(0));
        black.exposures.push_back({t, 1, 0, 0});
    }
    EXPECT_THROW(calibrate_response(black), gi::InputError);
}

TEST(Vignetting, IsThatOfFlatFields)
{
    Photometry truth = film_photometry();
    truth.vignetting = {-0.35, 0.12, -0.08};
    auto const worst = [&](std::array<double, 3> const& v) {
        double most = 0;
        for (double r = 0; r <= 1; r += 0.05) {
            auto const g = [r](std::array<double, 3> const& k) {
                return 1 + r * r * (k[0] + r * r * (k[1] + r * r * k[2]));
            };
            most = std::max(most, std::abs(g(v) / g(truth.vignetting) - 1));
        }
        return most;
    };
    std::vector<cv::Mat> flats;
    for (double level : {0.3, 0.5})
        flats.push_back(photograph(cv::Mat(240, 320, CV_32FC3, cv::Scalar(level, 0.9 * level, 0.7 * level)), truth,
                                   1, {1e-7, 1e-4}, flats.size()));
    VignettingFit const flat = vignetting_of_flat(flats, truth);
    fmt::print("vignetting: off by {:.3f} % at most; rms {:.4f} of {} parts\n", 100 * worst(flat.vignetting),
               flat.rms, flat.points.size());
    EXPECT_LT(worst(flat.vignetting), 0.005);
    EXPECT_LT(flat.rms, 0.01);
    EXPECT_EQ(flat.points.size(), 2u * 3 * 24 * 24);
    for (cv::Point2d const& p : flat.points)
        EXPECT_NEAR(p.y / (1 + p.x * p.x * (-0.35 + p.x * p.x * (0.12 - 0.08 * p.x * p.x))), 1, 0.02);
    EXPECT_THROW(vignetting_of_flat({}, truth), gi::InputError);
    // Of the corners nothing is known where they are black.
    cv::circle(flats[0], {160, 120}, 190, cv::Scalar::all(0), 160);
    EXPECT_THROW(vignetting_of_flat(std::span(flats).first(1), truth), gi::InputError);
}

TEST(Noise, IsThatOfTheSensor)
{
    Photometry const truth = film_photometry();
    Noise const noise{4e-5, 6e-4};
    cv::Mat const light = 0.4 * scene({400, 300});
    std::vector<cv::Mat> frames;
    for (std::uint64_t i = 0; i < 4; ++i) frames.push_back(photograph(light, truth, 1, noise, 10 + i));
    NoiseFit const fit = noise_of_pairs(frames, truth);
    NoiseModel const& m = fit.noise;
    double most = 0;
    for (double u : {0.05, 0.1, 0.3, 0.6, 0.9})
        most = std::max(most, std::abs(m.sigma(u) / std::sqrt(noise.read + noise.photon * u) - 1));
    fmt::print("noise: read {:.3g} (truth {:.3g}), photon {:.4g} (truth {:.3g}); sigma off by {:.2f} % at most; "
               "line {:.3f}\n",
               m.read, noise.read, m.photon, noise.photon, 100 * most, fit.rms);
    EXPECT_LT(most, 0.05);
    EXPECT_THROW(noise_of_pairs(std::span(frames).first(3), truth), gi::InputError);
    frames.resize(2);
    frames[0].setTo(50);
    frames[1].setTo(50);
    EXPECT_THROW(noise_of_pairs(frames, truth), gi::InputError);
}

TEST(Colour, MatrixIsFoundFromAChart)
{
    Photometry truth = film_photometry();
    truth.colour = {1.7f, -0.5f, -0.15f, -0.25f, 1.5f, -0.3f, 0.02f, -0.6f, 1.6f};
    truth.vignetting = {-0.2, 0, 0};
    auto const& chart = chart_linear_rgb();
    cv::Mat light(240, 360, CV_32FC3, cv::Scalar::all(0.02));
    std::vector<cv::Point2d> centres;
    for (int i = 0; i < 24; ++i) {
        cv::Rect const r(60 * (i % 6) + 10, 60 * (i / 6) + 10, 40, 40);
        light(r).setTo(0.8 *
                       cv::Scalar(chart[std::size_t(i)][0], chart[std::size_t(i)][1], chart[std::size_t(i)][2]));
        centres.emplace_back(r.x + 19.5, r.y + 19.5);
    }
    cv::Mat const picture = photograph(light, truth, 1, {1e-7, 1e-4}, 1);
    auto const units = patch_units(picture, centres, 15, truth);
    ColourFit const fit = fit_colour(units, chart);
    // What remains unknown is how bright the chart is lit.
    cv::Matx33f const same = fit.colour * truth.colour.inv();
    double const scale = (same(0, 0) + same(1, 1) + same(2, 2)) / 3;
    double most = 0;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(same(r, c) / scale - (r == c ? 1 : 0)));
    fmt::print(
        "colour: mean delta E {:.2f}, largest {:.2f} (without a matrix {:.1f}); off from the truth by {:.4f}\n",
        fit.mean_delta_e, fit.largest_delta_e, fit.delta_e_before, most);
    EXPECT_LT(fit.mean_delta_e, 1);
    EXPECT_LT(most, 0.02);
    EXPECT_GT(fit.delta_e_before, 5);
    // The corner patches tell where the others are, through perspective and a lens.
    CameraModel const camera{LensModel::radial_tangential, {360, 240}, 300, 300, 179.5, 119.5,
                             {-0.2, 0.05, 0, 0, 0}};
    auto const on_chart = [&](int i) {
        return *project(camera, {-0.3 + 0.11 * (i % 6), -0.2 + 0.12 * (i / 6), 1.2 + 0.03 * (i % 6)});
    };
    std::array<cv::Point2d, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) {
        glm::dvec2 const p = on_chart(std::array{0, 5, 23, 18}[k]);
        corners[k] = {p.x, p.y};
    }
    auto const found = chart_centres(corners, camera);
    ASSERT_EQ(found.size(), 24u);
    for (int i = 0; i < 24; ++i) {
        EXPECT_NEAR(found[std::size_t(i)].x, on_chart(i).x, 0.01) << i;
        EXPECT_NEAR(found[std::size_t(i)].y, on_chart(i).y, 0.01) << i;
    }
    std::swap(corners[1], corners[2]);
    EXPECT_THROW(chart_centres(corners, camera), gi::InputError);
    EXPECT_THROW(patch_units(picture, std::vector<cv::Point2d>{{1, 1}}, 15, truth), gi::InputError);
    EXPECT_THROW(fit_colour(std::vector<cv::Vec3f>(24, {0.1f, 0.1f, 0.1f}), chart), gi::InputError);
}

} // namespace
} // namespace ar::test
