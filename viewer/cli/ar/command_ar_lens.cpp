#include "ar/calibration/calibration_file.h"
#include "ar/calibration/stmap.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/base/outputs.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct LensOptions {
    std::string calibration, stmap, undistort, opencv;
};

/// Largest distance that the lens moves a pixel, and how exactly its two directions are inverse.
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
            if (auto const p = ar::project(straight, *d)) moved_px = std::max(moved_px, glm::length(*p - pixel));
            if (auto const p = ar::project(c, *d)) error_px = std::max(error_px, glm::length(*p - pixel));
        }
    return fmt::format(
        "{}, {} x {} px, focal length {:.2f} x {:.2f} px: moves pixels by up to {:.2f} px, inverted to "
        "{:.1g} px\n",
        name_of(c.lens), c.size_px.x, c.size_px.y, c.fx, c.fy, moved_px, error_px);
}

int run_lens(LensOptions const& o)
{
    ar::Calibration const c = ar::read_calibration(o.calibration);
    check_outputs({o.stmap, o.undistort, o.opencv}, {o.calibration, c.stmap.string()});
    for (std::string const& file : {o.stmap, o.undistort})
        if (!file.empty()) check_ending(file, ".exr", "an STMap", "name it .exr");
    if (!o.opencv.empty() && c.camera.lens == ar::LensModel::stmap)
        throw gi::InputError("--opencv of a lens that is an STMap", "OpenCV's files hold coefficients, not tables",
                             "give its programs the map, --stmap FILE");
    if (!o.stmap.empty()) ar::write_stmap(o.stmap, ar::stmap_of(c.camera, ar::StMap::distort));
    if (!o.undistort.empty()) ar::write_stmap(o.undistort, ar::stmap_of(c.camera, ar::StMap::undistort));
    if (!o.opencv.empty()) {
        ar::Calibration lens;
        lens.camera = c.camera;
        gi::write_text(o.opencv, ar::format_calibration(lens));
    }
    fmt::print("{}", describe(c.camera));
    for (std::string const& file : {o.stmap, o.undistort, o.opencv})
        if (!file.empty()) fmt::print("{}\n", file);
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
