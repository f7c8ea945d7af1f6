#include "ar/calibration/report.h"

#include "gi/core/base64.h"
#include "gi/core/html/html.h"
#include "gi/core/html/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

std::string image_of(cv::Mat const& picture, glm::ivec2 size)
{
    if (picture.empty()) return {};
    cv::Mat bgr;
    cv::cvtColor(picture, bgr, picture.channels() == 3 ? cv::COLOR_RGB2BGR : cv::COLOR_GRAY2BGR);
    std::vector<std::uint8_t> jpeg;
    cv::imencode(".jpg", bgr, jpeg, {cv::IMWRITE_JPEG_QUALITY, 80});
    return fmt::format("<image width=\"{}\" height=\"{}\" opacity=\"0.3\" href=\"data:image/jpeg;base64,{}\"/>",
                       size.x, size.y, gi::encode_base64(jpeg));
}

/// Residual arrows at the observed points, 50 times enlarged; views left out in another colour.
std::string residual_drawing(CalibrationReport const& r)
{
    auto const& c = r.lens.camera;
    constexpr double kLonger = 50;
    double const stroke = c.size_px.x / 800.;
    std::string s = fmt::format("<svg viewBox=\"-0.5 -0.5 {} {}\" width=\"800\">", c.size_px.x, c.size_px.y);
    s += image_of(r.background, c.size_px);
    for (std::size_t v = 0; v < r.views.size() && v < r.lens.views.size(); ++v) {
        ViewResult const& result = r.lens.views[v];
        std::string path;
        for (std::size_t i = 0; i < result.residuals_px.size() && i < r.views[v].pixels.size(); ++i) {
            glm::dvec2 const p = r.views[v].pixels[i], d = kLonger * result.residuals_px[i];
            path += fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}", p.x, p.y, d.x, d.y);
        }
        s += fmt::format("<path class=\"{}\" d=\"{}\" stroke-width=\"{:.2f}\"><title>{}</title></path>",
                         result.used ? "c0" : "c1", path, stroke, gi::escaped(result.name));
    }
    return gi::html_figure(s + "</svg>\n",
                           "What each point is off, 50 times as long. Orange: views that were left out.");
}

std::string coverage_drawing(CalibrationReport const& r)
{
    constexpr int kAcross = 16, kDown = 12;
    auto const size = r.lens.camera.size_px;
    std::array<std::array<int, kAcross>, kDown> count{};
    int most = 1;
    for (std::size_t v = 0; v < r.views.size() && v < r.lens.views.size(); ++v)
        if (r.lens.views[v].used)
            for (auto const& p : r.views[v].pixels) {
                int const x = std::clamp(int((p.x + 0.5) / size.x * kAcross), 0, kAcross - 1);
                int const y = std::clamp(int((p.y + 0.5) / size.y * kDown), 0, kDown - 1);
                most = std::max(most, ++count[std::size_t(y)][std::size_t(x)]);
            }
    std::vector<std::vector<gi::ShadedCell>> cells(kDown);
    for (std::size_t y = 0; y < kDown; ++y)
        for (int const n : count[y]) cells[y].push_back({std::to_string(n), n == 0 ? 0 : 0.15 + 0.75 * n / most});
    return gi::html_figure(gi::html_matrix("", {}, cells),
                           fmt::format("Points in each part of the picture; {:.0f} % of 8 x 6 parts have some.",
                                       100 * r.lens.coverage));
}

std::string view_table(LensCalibration const& lens)
{
    double most = 1e-9;
    for (auto const& v : lens.views) most = std::max(most, v.rms_px);
    std::vector<std::vector<gi::HtmlCell>> rows;
    for (auto const& v : lens.views)
        rows.push_back({v.name, std::to_string(v.residuals_px.size()), fmt::format("{:.3f}", v.rms_px),
                        gi::HtmlCell::of(fmt::format("<div class=\"bar{}\" style=\"width:{:.0f}px\"></div>",
                                                     v.used ? "" : " out", 200 * v.rms_px / most)),
                        fmt::format("{:.3f}", glm::length(v.camera_from_board.position)),
                        v.used ? "" : "left out: " + v.why});
    return gi::html_table({{"view", false, ""},
                           {"points", true, ""},
                           {"RMS, px", true, ""},
                           {"", false, ""},
                           {"distance, m", true, ""},
                           {"", false, ""}},
                          rows);
}

std::string curve_figure(Photometry const& p)
{
    constexpr std::array kStyles{"curve c1", "curve c2", "curve c0"};
    double most = 1e-9;
    for (auto const& c : p.unit_of_byte) most = std::max(most, double(c[255]));
    gi::Plot plot(640, 380, {0, 255}, {0, 1.04 * most});
    plot.margins(70, 12, 20, 46);
    plot.x_axis("byte");
    plot.y_axis("light of each byte, units");
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<std::pair<double, double>> line;
        for (std::size_t i = 0; i < 256; ++i) line.emplace_back(double(i), p.unit_of_byte[c][i]);
        plot.curve(line, kStyles[c]);
    }
    auto const& g = p.vignetting;
    return plot.figure(
        "response", fmt::format("Light of each byte, in units: red (orange line), green, blue. Vignetting leaves "
                                "{:.1f} % in the corners (1 {:+.4f} r² {:+.4f} r⁴ {:+.4f} r⁶).",
                                100 * (1 + g[0] + g[1] + g[2]), g[0], g[1], g[2]));
}

std::string lens_tables(CalibrationReport const& r)
{
    std::vector<std::vector<gi::HtmlCell>> rows, trials;
    auto const values = parameters_of(r.lens.camera);
    for (std::size_t i = 0; i < values.size() && i < r.lens.standard_deviations.size(); ++i)
        rows.push_back({r.lens.parameters[i], fmt::format("{:.6g}", values[i]),
                        fmt::format("{:.2g}", r.lens.standard_deviations[i])});
    std::string const html =
        gi::html_table({{"parameter", false, ""}, {"value", true, ""}, {"standard deviation", true, ""}}, rows);
    if (!r.choice) return html;
    for (auto const& t : r.choice->trials) {
        bool const fitted = t.failed.empty();
        trials.push_back({name_of(t.lens), fitted ? fmt::format("{:.4f}", t.fitted_rms_px) : "",
                          fitted ? fmt::format("{:.4f}", t.validated_rms_px) : "",
                          !fitted                      ? t.failed
                          : t.lens == r.choice->chosen ? "chosen"
                                                       : ""});
    }
    return html +
           gi::html_table(
               {{"model", false, ""}, {"fitted, px", true, ""}, {"unseen views, px", true, ""}, {"", false, ""}},
               trials) +
           gi::html_paragraph(r.choice->why);
}

} // namespace

std::string to_html(CalibrationReport const& r)
{
    auto const& c = r.lens.camera;
    std::string const about = gi::html_paragraph(
        fmt::format("{} x {} pixels, {}; {} of {} views; RMS reprojection error {:.3f} px.", c.size_px.x,
                    c.size_px.y, name_of(c.lens), r.lens.used_views(), r.lens.views.size(), r.lens.rms_px),
        "about");
    std::string html =
        gi::html_section("Lens", lens_tables(r)) + gi::html_section("Residuals", residual_drawing(r)) +
        gi::html_section("Coverage", coverage_drawing(r)) + gi::html_section("Views", view_table(r.lens));
    if (r.photometry) html += gi::html_section("Response", curve_figure(*r.photometry));
    if (r.noise)
        html += gi::html_section("Noise", gi::html_paragraph(fmt::format(
                                              "Variance of a unit: {:.3g} + {:.3g} unit; sigma at 0.18: {:.4f}.",
                                              r.noise->read, r.noise->photon, r.noise->sigma(0.18))));
    return gi::html_page("Camera calibration", html, about + gi::html_cautions(r.lens.warnings));
}

} // namespace ar
