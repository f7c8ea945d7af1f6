#include "ar/calibration/calibration_file.h"
#include "ar/calibration/stmap.h"
#include "ar/camera/lens_domain.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct LensOptions {
    std::string calibration, stmap, undistort, opencv;
};

/// Largest distance that the lens moves a pixel, as far as a pinhole picture shows it, how exactly its two
/// directions are inverse, and where the model holds.
std::string describe(ar::CameraModel const& c)
{
    ar::CameraModel straight = c;
    straight.lens = ar::LensModel::pinhole;
    straight.distortion = {};
    double moved_px = 0, error_px = 0;
    for (int y = 0; y < c.size_px.y; y += 4)
        for (int x = 0; x < c.size_px.x; x += 4) {
            glm::dvec2 const pixel(x, y);
            auto const d = ar::direction_of(c, pixel);
            if (!d) continue;
            if (d->z > std::cos(glm::radians(ar::kWide_deg)))
                if (auto const p = ar::project(straight, *d))
                    moved_px = std::max(moved_px, glm::length(*p - pixel));
            if (auto const p = ar::project(c, *d)) error_px = std::max(error_px, glm::length(*p - pixel));
        }
    ar::LensReach const reach = ar::reach_of(c);
    std::string const within =
        reach.share_wide > 0 ? fmt::format(" within {:g} degrees of its axis", ar::kWide_deg) : "";
    std::string text = fmt::format(
        "{}, {} x {} px, focal length {:.2f} x {:.2f} px: moves pixels by up to {:.2f} px{}, inverted to "
        "{:.1g} px\n",
        name_of(c.lens), c.size_px.x, c.size_px.y, c.fx, c.fy, moved_px, within, error_px);
    text += fmt::format("{}\n", describe(reach));
    if (reach.share_wide > 0)
        text += fmt::format("{:.3g} % of the picture is {:g} degrees or more off the axis: no pinhole picture "
                            "shows it, `ar track` uses it, `ar run` does not render it\n",
                            100 * reach.share_wide, ar::kWide_deg);
    return text;
}

int run_lens(LensOptions const& o)
{
    gi::Report report;
    ar::Calibration const c = ar::read_calibration(o.calibration, std::nullopt, &report);
    check_outputs({o.stmap, o.undistort, o.opencv}, {o.calibration, c.stmap.string()});
    for (std::string const& file : {o.stmap, o.undistort})
        if (!file.empty()) check_ending(file, ".exr", "an STMap", "name it .exr");
    if (!o.opencv.empty() && c.camera.lens == ar::LensModel::stmap)
        throw gi::InputError("--opencv of a lens that is an STMap", "OpenCV's files hold coefficients, not tables",
                             "give its programs the map, --stmap FILE");
    std::string placeless;
    auto const write = [&](std::string const& file, ar::StMap which) {
        if (file.empty()) return;
        cv::Mat const st = ar::stmap_of(c.camera, which);
        ar::write_stmap(file, st);
        int const n = ar::placeless_px(st);
        if (n > 0) placeless += fmt::format("{}: {} pixels have no place in the source: (-1, -1)\n", file, n);
    };
    write(o.stmap, ar::StMap::distort);
    write(o.undistort, ar::StMap::undistort);
    if (!o.opencv.empty()) {
        ar::Calibration lens;
        lens.camera = c.camera;
        gi::write_text(o.opencv, ar::format_calibration(lens));
    }
    fmt::print("{}{}", describe(c.camera), placeless);
    for (std::string const& file : {o.stmap, o.undistort, o.opencv})
        if (!file.empty()) fmt::print("{}\n", file);
    print_losses(report);
    return 0;
}

} // namespace

void add_ar_lens(CLI::App& ar, int& exit_code)
{
    auto const o = std::make_shared<LensOptions>();
    CLI::App* const c =
        ar.add_subcommand("lens", "Show a calibration's lens, or write it as STMaps or for OpenCV");
    c->add_option("calibration", o->calibration, "Calibration file (also OpenCV's)")->required();
    c->add_option("--stmap", o->stmap,
                  "STMap (EXR) that distorts pictures: calibrations read it as a lens (key stmap)");
    c->add_option("--undistort", o->undistort, "STMap (EXR) that removes the distortion");
    c->add_option("--opencv", o->opencv, "The lens alone, as OpenCV's programs read it (YAML)");
    c->footer(R"(Example:
  lightwell ar lens camera.yaml --stmap distort.exr --undistort undistort.exr

STMaps are Nuke's: R, G = s, t at pixel centres, 0..1, the origin at the bottom left.)");
    c->callback([o, &exit_code] { exit_code = run_lens(*o); });
}

} // namespace viewer
