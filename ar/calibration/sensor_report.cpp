#include "ar/calibration/sensor_report.h"

#include "gi/core/html/html.h"
#include "gi/core/html/plot.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ar {
namespace {

/// A curve among the measurements that it was fitted to; both axes from 0.
std::string fit_figure(std::vector<cv::Point2d> const& points, std::vector<std::pair<double, double>> const& curve,
                       std::string const& across, std::string const& up, std::string const& caption)
{
    cv::Point2d most(1e-12, 1e-12);
    auto const hold = [&](double x, double y) { most = {std::max(most.x, x), std::max(most.y, y)}; };
    for (cv::Point2d const& p : points) hold(p.x, p.y);
    for (auto const& [x, y] : curve) hold(x, y);
    gi::Plot plot(640, 380, {0, most.x}, {0, 1.04 * most.y});
    plot.margins(70, 12, 20, 46);
    plot.x_axis(across);
    plot.y_axis(up);
    for (cv::Point2d const& p : points) plot.dot(plot.x(p.x), plot.y(p.y), 1.5, "point");
    plot.curve(curve, "curve c1");
    return plot.figure(up + " by " + across, caption);
}

std::string vignetting_part(VignettingFit const& fit)
{
    auto const& v = fit.vignetting;
    std::vector<std::pair<double, double>> curve;
    for (int i = 0; i <= 100; ++i) {
        double const r2 = 1e-4 * i * i;
        curve.emplace_back(0.01 * i, 1 + r2 * (v[0] + r2 * (v[1] + r2 * v[2])));
    }
    return gi::html_section(
        "Vignetting",
        fit_figure(
            fit.points, curve, "radius (1: corners)", "light relative to the centre",
            fmt::format("{:.1f} % of the light is left in the corners (1 {:+.4f} r² {:+.4f} r⁴ {:+.4f} r⁶); "
                        "{} parts of the pictures are off by {:.2f} % RMS.",
                        100 * (1 + v[0] + v[1] + v[2]), v[0], v[1], v[2], fit.points.size(), 100 * fit.rms)));
}

std::string noise_part(NoiseFit const& fit)
{
    double most = 0;
    for (cv::Point2d const& p : fit.points) most = std::max(most, p.x);
    NoiseModel const& n = fit.noise;
    return gi::html_section(
        "Noise",
        fit_figure(fit.points, {{0, n.read}, {most, n.read + n.photon * most}}, "unit", "variance",
                   fmt::format("Variance of a unit: {:.3g} + {:.3g} unit; sigma at 0.18: {:.4f}. Variances "
                               "at {} brightnesses are off that line by {:.1f} % RMS.",
                               n.read, n.photon, n.sigma(0.18), fit.points.size(), 100 * fit.rms)));
}

/// A colour of linear RGB for a page.
std::string css(cv::Vec3f const& linear)
{
    std::string s = "rgb(";
    for (int c = 0; c < 3; ++c) {
        double const v = std::clamp(double(linear[c]), 0., 1.);
        double const encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
        s += fmt::format("{}{}", c > 0 ? "," : "", int(std::lround(255 * encoded)));
    }
    return s + ")";
}

std::string colour_part(ColourFit const& fit, std::vector<cv::Vec3f> const& patches)
{
    std::vector<std::vector<gi::HtmlCell>> matrix, rows;
    for (int r = 0; r < 3; ++r) {
        matrix.emplace_back();
        for (int c = 0; c < 3; ++c) matrix.back().push_back(fmt::format("{:+.4f}", fit.colour(r, c)));
    }
    auto const& chart = chart_linear_rgb();
    auto const patch = [](cv::Vec3f const& linear) {
        return gi::HtmlCell::of("", "width:6em;background:" + css(linear));
    };
    for (std::size_t i = 0; i < fit.delta_e.size() && i < patches.size() && i < chart.size(); ++i)
        rows.push_back({std::to_string(i + 1), patch(chart[i]),
                        patch(float(fit.brightness) * (fit.colour * patches[i])),
                        fmt::format("{:.2f}", fit.delta_e[i])});
    return gi::html_section(
        "Colour",
        gi::html_table({{"red", true, ""}, {"green", true, ""}, {"blue", true, ""}}, matrix) +
            gi::html_paragraph(
                fmt::format("Linear RGB of the camera's. ΔE (CIE 1976): mean {:.2f}, largest {:.2f}; "
                            "without the matrix {:.2f}.",
                            fit.mean_delta_e, fit.largest_delta_e, fit.delta_e_before)) +
            gi::html_table({{"patch", true, ""}, {"chart", false, ""}, {"camera", false, ""}, {"ΔE", true, ""}},
                           rows));
}

} // namespace

std::string to_html(SensorReport const& r)
{
    std::string html;
    if (r.vignetting) html += vignetting_part(*r.vignetting);
    if (r.noise) html += noise_part(*r.noise);
    if (r.colour) html += colour_part(*r.colour, r.patches);
    return gi::html_page("Camera sensor", html);
}

} // namespace ar
