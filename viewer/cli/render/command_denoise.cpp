#include "gi/core/error.h"
#include "gi/filter/filter_names.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/base/standard_streams.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"
#include "viewer/offline/finish_picture.h"

#include <CLI/CLI.hpp>
#include <memory>

namespace viewer {
namespace {

/// A picture that was saved without a filter.
gi::Picture noisy_picture(std::string const& file)
{
    gi::Picture picture = gi::read_exr(file);
    auto const filter = picture.metadata.find("denoise");
    if (filter != picture.metadata.end() && filter->second != "none")
        throw gi::InputError("'" + file + "' is filtered already", "it was saved with --denoise " + filter->second,
                             "render it without, to filter it afterwards");
    return picture;
}

int run(RenderOptions const& o, std::string const& file)
{
    if (o.out.empty() && o.png.empty())
        throw gi::InputError("there is nothing to write", "neither --out nor --png is given",
                             "add --out F.exr or --png F.png");
    if (o.denoise == "none")
        throw gi::InputError("--denoise none", "it leaves a picture as it is", "choose one that --help lists");
    check_ending(o.out, ".exr", "an OpenEXR picture", "use --png for a PNG, or end it with .exr");
    check_ending(o.png, ".png", "a PNG", "end it with .png");
    check_outputs({o.out, o.png}, {file});
    gi::DenoiseSettings settings = gi::find_filter(o.denoise);
    gi::check_filter(settings);
    settings.threads = o.settings.threads;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    settings.stop = &stop;
    gi::Report report;
    gi::Picture picture = noisy_picture(file);
    split_alpha(picture);
    std::string const note = denoise(picture, settings, report);
    if (!note.empty()) say(note);
    picture.metadata["denoise"] = o.denoise;
    write_files(o, gi::rows_of(picture), &stop, report);
    print_losses(report);
    return 0;
}

} // namespace

void add_denoise(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<RenderOptions>();
    auto const file = std::make_shared<std::string>();
    o->denoise = "atrous";
    CLI::App* const c = app.add_subcommand("denoise", about("denoise"));
    c->add_option("PICTURE", *file, "EXR of render --out with all layers, not filtered")->required();
    declare_denoise(*c, *o);
    c->add_option("-o,--out", o->out, "EXR file for all layers, .exr");
    declare_pixels(*c, *o, "--png");
    declare_option(*c, o->settings, "threads");
    c->footer(R"(Prepared by:
  lightwell render cornell --size 64x64 --paths 16 --out noisy.exr
Examples:
  lightwell denoise noisy.exr --out smooth.exr --png smooth.png
  lightwell denoise noisy.exr --denoise wide --exposure 1 --png bright.png)");
    c->callback([o, file, &exit_code] { exit_code = run(*o, *file); });
}

} // namespace viewer
