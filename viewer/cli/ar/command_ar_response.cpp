#include "ar/calibration/calibration_file.h"
#include "ar/calibration/response.h"
#include "gi/core/error.h"
#include "viewer/base/outputs.h"
#include "viewer/cli/ar/ar_arguments.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct ResponseOptions {
    std::vector<std::string> pictures;
    std::string exposures, calibration, out;
};

int run_response(ResponseOptions const& o)
{
    check_outputs({o.out}, o.pictures);
    ar::Calibration calibration = ar::read_calibration(o.calibration);
    auto const seconds = parse_exposures(o.exposures);
    if (seconds.size() != o.pictures.size())
        throw gi::InputError(fmt::format("{} pictures and {} exposures", o.pictures.size(), seconds.size()),
                             "each picture needs one", "give --exposures in the order of the pictures");
    ar::Bracket bracket;
    for (std::size_t i = 0; i < seconds.size(); ++i) {
        bracket.rgb.push_back(read_rgb(o.pictures[i]));
        ar::Exposure e;
        e.time_s = seconds[i];
        bracket.exposures.push_back(e);
    }
    ar::ResponseFit fit = ar::calibrate_response(bracket);
    if (calibration.photometry) { // measured separately from the response
        fit.photometry.vignetting = calibration.photometry->vignetting;
        fit.photometry.colour = calibration.photometry->colour;
    }
    calibration.photometry = fit.photometry;
    std::string const out = o.out.empty() ? o.calibration : o.out;
    ar::write_calibration(out, calibration);
    auto const& d = fit.disagreement;
    fmt::print(
        "exposures disagree by {:.2f} %, {:.2f} %, {:.2f} % (red, green, blue; RMS); {} entries of the curve "
        "levelled\nreference exposure: {:.6g} s\n{}\n",
        100 * d[0], 100 * d[1], 100 * d[2], fit.levelled, fit.photometry.reference.time_s, out);
    return 0;
}

} // namespace

void add_ar_response(CLI::App& ar, int& exit_code)
{
    auto const o = std::make_shared<ResponseOptions>();
    CLI::App* const c = ar.add_subcommand(
        "response", "Add the response (radiance of each byte) to a calibration, from several exposures.");
    c->add_option("PICTURES", o->pictures, "pictures of a static scene from one place, 8 bits")->required();
    c->add_option("--exposures", o->exposures, "exposure time of each picture, s: 1/30,1/60,1/120")->required();
    c->add_option("--calibration", o->calibration, "calibration file to add it to")->required();
    c->add_option("-o,--out", o->out, "write to this file and leave --calibration unchanged");
    c->footer(R"(Example:
  lightwell ar response a.png b.png c.png --exposures 1/30,1/60,1/120 --calibration camera.yaml

An earlier response in the file is replaced; vignetting and colour are kept.)");
    c->callback([o, &exit_code] { exit_code = run_response(*o); });
}

} // namespace viewer
