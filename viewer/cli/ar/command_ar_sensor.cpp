// Commands that add vignetting, noise and colour of a camera to its calibration file, each from special pictures.

#include "ar/calibration/calibration_file.h"
#include "ar/calibration/sensor_report.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/text.h"
#include "viewer/base/outputs.h"
#include "viewer/cli/ar/ar_arguments.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct SensorOptions {
    std::vector<std::string> pictures, centres;
    std::string calibration, out, report;
    double half_px = 0; ///< 0: from the distance of patches
};

void declare_sensor_options(CLI::App& c, SensorOptions& o)
{
    c.add_option("--calibration", o.calibration, "calibration file to add it to")->required();
    c.add_option("-o,--out", o.out, "write to this file and leave --calibration unchanged");
    c.add_option("--report", o.report, "HTML page with the fit and the measured values");
}

/// A calibration to extend, with the pictures to do it from.
struct SensorSession {
    SensorOptions const& options;
    ar::Calibration calibration;
    std::vector<cv::Mat> rgb;
    ar::SensorReport report;

    explicit SensorSession(SensorOptions const& o) : options(o)
    {
        check_outputs({o.out, o.report}, o.pictures);
        check_outputs({o.report}, {o.calibration});
        calibration = ar::read_calibration(o.calibration);
        glm::ivec2 const size = calibration.camera.size_px;
        for (std::string const& file : o.pictures) {
            rgb.push_back(read_rgb(file));
            if (rgb.back().cols != size.x || rgb.back().rows != size.y)
                throw gi::InputError(fmt::format("{} has {} x {} pixels, {} is for {} x {}", file, rgb.back().cols,
                                                 rgb.back().rows, o.calibration, size.x, size.y),
                                     "both must be from one camera, neither scaled nor cropped",
                                     "use the pictures as the camera delivers them");
        }
        if (calibration.photometry) return;
        calibration.photometry = ar::srgb_photometry(); // as `ar run` does
        fmt::print("{} has no response: bytes are assumed to be sRGB (measure it with lightwell ar response)\n",
                   o.calibration);
    }

    /// @param fit description of the fit and its error, for the file's provenance
    void write(std::string const& name, std::string const& fit)
    {
        auto& p = calibration.provenance;
        std::erase_if(p, [&](auto const& entry) { return entry.first == name; });
        p.emplace_back(name, fit);
        std::string const out = options.out.empty() ? options.calibration : options.out;
        ar::write_calibration(out, calibration);
        if (!options.report.empty()) gi::write_text(options.report, ar::to_html(report));
        fmt::print("{}\n", out);
    }
};

int run_vignetting(SensorOptions const& o)
{
    SensorSession s(o);
    ar::VignettingFit const fit = ar::vignetting_of_flat(s.rgb, *s.calibration.photometry);
    auto const& v = fit.vignetting;
    s.calibration.photometry->vignetting = v;
    s.report.vignetting = fit;
    fmt::print("vignetting: 1 {:+.4f} r^2 {:+.4f} r^4 {:+.4f} r^6, {:.1f} % of the light in the corners\n", v[0],
               v[1], v[2], 100 * (1 + v[0] + v[1] + v[2]));
    std::string const error = fmt::format("{:.2f} % RMS of {} regions of {} pictures", 100 * fit.rms,
                                          fit.points.size(), o.pictures.size());
    fmt::print("error: {}\n", error);
    if (fit.rms > 0.03) fmt::print("warning: the surface seems not to be evenly bright: rotate it and compare\n");
    s.write("vignetting", error);
    return 0;
}

int run_noise(SensorOptions const& o)
{
    SensorSession s(o);
    ar::NoiseFit const fit = ar::noise_of_pairs(s.rgb, *s.calibration.photometry);
    s.calibration.noise = fit.noise;
    s.report.noise = fit;
    fmt::print("noise: variance {:.4g} + {:.4g} unit; sigma {:.4f} at 0.18\n", fit.noise.read, fit.noise.photon,
               fit.noise.sigma(0.18));
    std::string const error = fmt::format("{:.1f} % RMS of the variances at {} brightness levels of {} pairs",
                                          100 * fit.rms, fit.points.size(), o.pictures.size() / 2);
    fmt::print("error: {}\n", error);
    if (fit.rms > 0.5)
        fmt::print("warning: no line fits the variances: did something move, or did the light flicker?\n");
    s.write("noise", error);
    return 0;
}

cv::Point2d parse_pixel(std::string const& text)
{
    std::string_view y = text;
    std::string_view const x = gi::take_until(y, ',');
    if (auto const px = gi::parse_finite(x), py = gi::parse_finite(y); px && py) return {*px, *py};
    throw gi::InputError("--patches " + text, "the centre of a patch is two numbers, px from the upper left",
                         "write it as 120,85.5");
}

std::vector<cv::Point2d> patch_centres(SensorOptions const& o, ar::CameraModel const& camera)
{
    std::vector<cv::Point2d> given;
    for (std::string const& text : o.centres) given.push_back(parse_pixel(text));
    if (given.size() == ar::chart_linear_rgb().size()) return given;
    if (given.size() == 4) return ar::chart_centres({given[0], given[1], given[2], given[3]}, camera);
    throw gi::InputError(fmt::format("--patches has {} centres", given.size()),
                         "the chart has 24 patches, 4 of them in its corners",
                         "give dark skin, bluish green, black and white, or all 24 row by row");
}

/// A fifth of the smallest distance between patches, so that squares lie well inside the patches.
double default_half_px(std::vector<cv::Point2d> const& centres)
{
    double least = 1e9;
    for (std::size_t i = 0; i < centres.size(); ++i)
        for (std::size_t j = i + 1; j < centres.size(); ++j)
            least = std::min(least, cv::norm(centres[i] - centres[j]));
    return 0.2 * least;
}

int run_colour(SensorOptions const& o)
{
    SensorSession s(o);
    auto const centres = patch_centres(o, s.calibration.camera);
    double const half_px = o.half_px > 0 ? o.half_px : default_half_px(centres);
    s.report.patches = ar::patch_units(s.rgb[0], centres, half_px, *s.calibration.photometry);
    ar::ColourFit const fit = ar::fit_colour(s.report.patches, ar::chart_linear_rgb());
    s.calibration.photometry->colour = fit.colour;
    s.report.colour = fit;
    for (int r = 0; r < 3; ++r)
        fmt::print("{} {:+.4f} {:+.4f} {:+.4f}\n", r == 0 ? "colour:" : "       ", fit.colour(r, 0),
                   fit.colour(r, 1), fit.colour(r, 2));
    auto const worst = std::max_element(fit.delta_e.begin(), fit.delta_e.end()) - fit.delta_e.begin();
    std::string const error =
        fmt::format("delta E (CIE 1976) mean {:.2f}, largest {:.2f}", fit.mean_delta_e, fit.largest_delta_e);
    fmt::print("error: {} (patch {}); {:.2f} without the matrix\n", error, worst + 1, fit.delta_e_before);
    s.write("colour", error);
    return 0;
}

} // namespace

void add_ar_vignetting(CLI::App& ar, int& exit_code)
{
    auto const o = std::make_shared<SensorOptions>();
    CLI::App* const c = ar.add_subcommand(
        "vignetting", "Add a lens's vignetting to a calibration, from pictures of an evenly bright surface.");
    c->add_option("PICTURES", o->pictures,
                  "pictures of a lit wall through paper, or of a clear sky, out of focus; 8 bits")
        ->required();
    declare_sensor_options(*c, *o);
    c->footer(R"(Example:
  lightwell ar vignetting flat1.png flat2.png --calibration camera.yaml --report vignetting.html

Two pictures, with the camera turned upside down in between, show whether the surface is evenly bright. Regions
with clipped pixels are ignored. Measure the response first (lightwell ar response): it makes bytes
linear.)");
    c->callback([o, &exit_code] { exit_code = run_vignetting(*o); });
}

void add_ar_noise(CLI::App& ar, int& exit_code)
{
    auto const o = std::make_shared<SensorOptions>();
    CLI::App* const c = ar.add_subcommand(
        "noise", "Add a sensor's noise to a calibration, from pairs of pictures of a static scene.");
    c->add_option("PICTURES", o->pictures,
                  "pairs: first, second, first, second, ... with equal exposure; 8 bits, not JPEG")
        ->required();
    declare_sensor_options(*c, *o);
    c->footer(R"(Example:
  lightwell ar noise a1.png a2.png b1.png b2.png --calibration camera.yaml --report noise.html

Use the exposure and gain of the later frames: noise is given per unit of light at that exposure. The scene needs
dark and bright parts.)");
    c->callback([o, &exit_code] { exit_code = run_noise(*o); });
}

void add_ar_colour(CLI::App& ar, int& exit_code)
{
    auto const o = std::make_shared<SensorOptions>();
    o->pictures.resize(1);
    CLI::App* const c = ar.add_subcommand(
        "colour",
        "Add a camera's colour matrix to a calibration, from a picture of a ColorChecker with 24 patches.");
    c->add_option("PICTURE", o->pictures[0], "the chart, evenly lit, nothing clipped; 8 bits")->required();
    c->add_option("--patches", o->centres,
                  "centres X,Y, px, of dark skin, bluish green, black and white (the corners), or of all 24")
        ->required()
        ->expected(1, 24);
    c->add_option("--half", o->half_px, "half the side of the square averaged in each patch, px")
        ->check(CLI::Range(0.5, 1000.0));
    declare_sensor_options(*c, *o);
    c->footer(R"(Example:
  lightwell ar colour chart.png --patches 92,80 548,82 545,388 95,385 --calibration camera.yaml --report colour.html

Measure response and vignetting first (lightwell ar response, lightwell ar vignetting). The matrix is valid only
for the illumination of the picture.)");
    c->callback([o, &exit_code] { exit_code = run_colour(*o); });
}

} // namespace viewer
