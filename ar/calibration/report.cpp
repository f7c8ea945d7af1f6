#include "ar/calibration/report.h"

#include "ar/calibration/page.h"
#include "gi/core/base64.h"
#include "gi/core/file.h"
#include "gi/core/html.h"

#include <algorithm>
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

/// Residual arrows at the observed points, 50 times enlarged; views left out are red.
std::string residual_drawing(CalibrationReport const& r)
{
    auto const& c = r.lens.camera;
    constexpr double kLonger = 50;
    double const stroke = c.size_px.x / 800.;
    std::string s = fmt::format("<svg viewBox=\"-0.5 -0.5 {} {}\" class=\"picture\">", c.size_px.x, c.size_px.y);
    s += image_of(r.background, c.size_px);
    for (std::size_t v = 0; v < r.views.size() && v < r.lens.views.size(); ++v) {
        ViewResult const& result = r.lens.views[v];
        std::string path;
        for (std::size_t i = 0; i < result.residuals_px.size() && i < r.views[v].pixels.size(); ++i) {
            glm::dvec2 const p = r.views[v].pixels[i], d = kLonger * result.residuals_px[i];
            path += fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}", p.x, p.y, d.x, d.y);
        }
        s += fmt::format(
            "<path d=\"{}\" stroke=\"{}\" stroke-width=\"{:.2f}\" fill=\"none\"><title>{}</title></path>", path,
            result.used ? "#1565c0" : "#c62828", stroke, gi::escaped(result.name));
    }
    return s + "</svg>\n<p>What each point is off, 50 times as long. Red: views that were left out.</p>\n";
}

std::string coverage_drawing(CalibrationReport const& r)
{
    constexpr int kAcross = 16, kDown = 12;
    auto const size = r.lens.camera.size_px;
    std::array<int, kAcross * kDown> count{};
    for (std::size_t v = 0; v < r.views.size() && v < r.lens.views.size(); ++v)
        if (r.lens.views[v].used)
            for (auto const& p : r.views[v].pixels) {
                int const x = std::clamp(int((p.x + 0.5) / size.x * kAcross), 0, kAcross - 1);
                int const y = std::clamp(int((p.y + 0.5) / size.y * kDown), 0, kDown - 1);
                ++count[std::size_t(kAcross * y + x)];
            }
    int const most = std::max(1, *std::max_element(count.begin(), count.end()));
    std::string s = fmt::format("<svg viewBox=\"0 0 {} {}\" class=\"picture\">", 40 * kAcross, 40 * kDown);
    for (int y = 0; y < kDown; ++y)
        for (int x = 0; x < kAcross; ++x) {
            int const n = count[std::size_t(kAcross * y + x)];
            s += fmt::format(
                "<rect x=\"{}\" y=\"{}\" width=\"39\" height=\"39\" fill=\"#2e7d32\" fill-opacity=\"{:.2f}\"/>"
                "<text x=\"{}\" y=\"{}\">{}</text>",
                40 * x, 40 * y, n == 0 ? 0 : 0.15 + 0.85 * n / most, 40 * x + 20, 40 * y + 25, n);
        }
    return s +
           fmt::format("</svg>\n<p>Points in each part of the picture; {:.0f} % of 8 x 6 parts have some.</p>\n",
                       100 * r.lens.coverage);
}

std::string view_table(LensCalibration const& lens)
{
    double most = 1e-9;
    for (auto const& v : lens.views) most = std::max(most, v.rms_px);
    std::string s =
        "<table><tr><th>view</th><th>points</th><th>RMS, px</th><th></th><th>distance, m</th><th></th></tr>\n";
    for (auto const& v : lens.views)
        s += fmt::format(
            "<tr><td>{}</td><td>{}</td><td>{:.3f}</td><td><div class=\"bar{}\" style=\"width:{:.0f}px\"></div>"
            "</td><td>{:.3f}</td><td>{}</td></tr>\n",
            gi::escaped(v.name), v.residuals_px.size(), v.rms_px, v.used ? "" : " out", 200 * v.rms_px / most,
            glm::length(v.camera_from_board.position_m), v.used ? "" : "left out: " + gi::escaped(v.why));
    return s + "</table>\n";
}

std::string curve_drawing(Photometry const& p)
{
    constexpr std::array<char const*, 3> colours{"#c62828", "#2e7d32", "#1565c0"};
    std::string s = "<svg viewBox=\"-40 -10 620 330\" class=\"picture\"><path d=\"M0 0V300H512\" stroke=\"#888\" "
                    "fill=\"none\"/>";
    float most = 1e-9f;
    for (auto const& c : p.unit_of_byte) most = std::max(most, c[255]);
    for (std::size_t c = 0; c < 3; ++c) {
        std::string path;
        for (std::size_t i = 0; i < 256; ++i)
            path += fmt::format("{}{} {:.2f}", i == 0 ? "M" : "L", 2 * i, 300 - 300 * p.unit_of_byte[c][i] / most);
        s += fmt::format("<path d=\"{}\" stroke=\"{}\" stroke-width=\"2\" fill=\"none\"/>", path, colours[c]);
    }
    s += fmt::format("<text x=\"256\" y=\"318\">byte, 0 to 255</text><text x=\"-4\" y=\"8\" "
                     "style=\"text-anchor:end\">{:.3g}</text></svg>\n",
                     most);
    auto const& g = p.vignetting;
    s += fmt::format(
        "<p>Light of each byte, in units. Vignetting leaves {:.1f} % in the corners (1 {:+.4f} r² {:+.4f} r⁴ "
        "{:+.4f} r⁶).</p>\n",
        100 * (1 + g[0] + g[1] + g[2]), g[0], g[1], g[2]);
    return s;
}

} // namespace

std::string to_html(CalibrationReport const& r)
{
    auto const& c = r.lens.camera;
    std::string s = page_begin("Camera calibration");
    s += fmt::format("<p>{} x {} pixels, {}; {} of {} views; RMS reprojection error {:.3f} "
                     "px.</p>\n",
                     c.size_px.x, c.size_px.y, name_of(c.lens), r.lens.used_views(), r.lens.views.size(),
                     r.lens.rms_px);
    for (auto const& w : r.lens.warnings) s += "<p class=\"warning\">" + gi::escaped(w) + "</p>\n";
    s += "<h2>Lens</h2>\n<table><tr><th></th><th>value</th><th>standard deviation</th></tr>\n";
    auto const values = parameters_of(c);
    for (std::size_t i = 0; i < values.size() && i < r.lens.standard_deviations.size(); ++i)
        s += fmt::format("<tr><td>{}</td><td>{:.6g}</td><td>{:.2g}</td></tr>\n", r.lens.parameters[i], values[i],
                         r.lens.standard_deviations[i]);
    s += "</table>\n";
    if (r.choice) {
        s += "<table><tr><th>model</th><th>fitted, px</th><th>unseen views, px</th><th></th></tr>\n";
        for (auto const& t : r.choice->trials)
            s += t.failed.empty() ? fmt::format("<tr><td>{}</td><td>{:.4f}</td><td>{:.4f}</td><td>{}</td></tr>\n",
                                                name_of(t.lens), t.fitted_rms_px, t.validated_rms_px,
                                                t.lens == r.choice->chosen ? "chosen" : "")
                                  : fmt::format("<tr><td>{}</td><td colspan=\"3\">{}</td></tr>\n", name_of(t.lens),
                                                gi::escaped(t.failed));
        s += "</table>\n<p>" + gi::escaped(r.choice->why) + "</p>\n";
    }
    s += "<h2>Residuals</h2>\n" + residual_drawing(r) + "<h2>Coverage</h2>\n" + coverage_drawing(r);
    s += "<h2>Views</h2>\n" + view_table(r.lens);
    if (r.photometry) s += "<h2>Response</h2>\n" + curve_drawing(*r.photometry);
    if (r.noise)
        s += fmt::format(
            "<h2>Noise</h2>\n<p>Variance of a unit: {:.3g} + {:.3g} unit; sigma at 0.18: {:.4f}.</p>\n",
            r.noise->read, r.noise->photon, r.noise->sigma(0.18));
    return s + page_end();
}

void write_report(std::filesystem::path const& file, CalibrationReport const& report)
{
    gi::write_text(file, to_html(report));
}

} // namespace ar
