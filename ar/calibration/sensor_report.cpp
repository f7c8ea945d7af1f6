#include "ar/calibration/sensor_report.h"

#include "ar/calibration/page.h"
#include "gi/core/file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ar {
namespace {

std::string vignetting_part(VignettingFit const& fit)
{
    auto const& v = fit.vignetting;
    std::vector<cv::Point2d> curve;
    for (int i = 0; i <= 100; ++i) {
        double const r2 = 1e-4 * i * i;
        curve.emplace_back(0.01 * i, 1 + r2 * (v[0] + r2 * (v[1] + r2 * v[2])));
    }
    return "<h2>Vignetting</h2>\n" +
           plot(fit.points, curve, "radius (1: corners)", "light relative to the centre") +
           fmt::format(
               "<p>{:.1f} % of the light is left in the corners (1 {:+.4f} r² {:+.4f} r⁴ {:+.4f} r⁶); {} parts of "
               "the pictures are off by {:.2f} % RMS.</p>\n",
               100 * (1 + v[0] + v[1] + v[2]), v[0], v[1], v[2], fit.points.size(), 100 * fit.rms);
}

std::string noise_part(NoiseFit const& fit)
{
    double most = 0;
    for (cv::Point2d const& p : fit.points) most = std::max(most, p.x);
    NoiseModel const& n = fit.noise;
    return "<h2>Noise</h2>\n" +
           plot(fit.points, {{0, n.read}, {most, n.read + n.photon * most}}, "unit", "variance") +
           fmt::format("<p>Variance of a unit: {:.3g} + {:.3g} unit; sigma at 0.18: {:.4f}. Variances at {} "
                       "brightnesses are off that line by {:.1f} % RMS.</p>\n",
                       n.read, n.photon, n.sigma(0.18), fit.points.size(), 100 * fit.rms);
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
    std::string s = "<h2>Colour</h2>\n<table>\n";
    for (int r = 0; r < 3; ++r)
        s += fmt::format("<tr><td>{:+.4f}</td><td>{:+.4f}</td><td>{:+.4f}</td></tr>\n", fit.colour(r, 0),
                         fit.colour(r, 1), fit.colour(r, 2));
    s += fmt::format(
        "</table>\n<p>Linear RGB of the camera's. ΔE (CIE 1976): mean {:.2f}, largest {:.2f}; without the matrix "
        "{:.2f}.</p>\n<table><tr><th>patch</th><th>chart</th><th>camera</th><th>ΔE</th></tr>\n",
        fit.mean_delta_e, fit.largest_delta_e, fit.delta_e_before);
    auto const& chart = chart_linear_rgb();
    for (std::size_t i = 0; i < fit.delta_e.size() && i < patches.size() && i < chart.size(); ++i)
        s += fmt::format(
            "<tr><td>{}</td><td style=\"background:{};width:6em\"></td><td style=\"background:{};width:6em\">"
            "</td><td>{:.2f}</td></tr>\n",
            i + 1, css(chart[i]), css(float(fit.brightness) * (fit.colour * patches[i])), fit.delta_e[i]);
    return s + "</table>\n";
}

} // namespace

std::string to_html(SensorReport const& r)
{
    std::string s = page_begin("Camera sensor");
    if (r.vignetting) s += vignetting_part(*r.vignetting);
    if (r.noise) s += noise_part(*r.noise);
    if (r.colour) s += colour_part(*r.colour, r.patches);
    return s + page_end();
}

void write_report(std::filesystem::path const& file, SensorReport const& report)
{
    gi::write_text(file, to_html(report));
}

} // namespace ar
