#include "ar/pipeline/synthesize.h"
#include "viewer/base/arguments.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/report_json.h"
#include "viewer/base/validators.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct SynthesizeArguments {
    ar::SynthesizeOptions options;
    std::string folder, size = "640x480", markers = "board";
    bool no_truth = false, no_denoise = false;
};

int run_synthesize(SynthesizeArguments const& a)
{
    ar::SynthesizeOptions o = a.options;
    o.folder = a.folder;
    auto const [width, height] = parse_size(a.size);
    o.size_px = {width, height};
    o.truth = !a.no_truth && !o.quick;
    o.markers = a.markers == "one"    ? ar::DeskMarkers::one
                : a.markers == "none" ? ar::DeskMarkers::none
                                      : ar::DeskMarkers::board;
    o.quality.denoise = !a.no_denoise;
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    int const done = ar::synthesize(o, stop, report);
    fmt::print("{}: {} of {} frames\n", (o.folder / "session.yaml").string(), done, o.frames);
    print_losses(report);
    return stop.requested() ? interrupted_code() : 0;
}

} // namespace

void add_ar_synthesize(CLI::App& ar, int& exit_code)
{
    auto const made = std::make_shared<SynthesizeArguments>();
    CLI::App* const synthesize = ar.add_subcommand(
        "synthesize", "Render a synthetic session: frames, true poses, environment map, reference pictures");
    synthesize->add_option("folder", made->folder, "Folder for its files")->required();
    synthesize->add_option("--size", made->size, "Frame size, WIDTHxHEIGHT")->capture_default_str();
    synthesize->add_option("--frames", made->options.frames, "Number of frames")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    synthesize->add_option("--paths", made->options.quality.paths, "Paths per pixel of the reference renderer")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    synthesize->add_option("--threads", made->options.quality.threads, "0 = all")
        ->check(CLI::NonNegativeNumber)
        ->transform(as_many_threads_as_there_are());
    synthesize->add_flag("--no-truth", made->no_truth,
                         "Do not render the reference pictures, which show the virtual objects as real ones");
    CLI::Option* const quick = synthesize->add_flag(
        "--quick", made->options.quick,
        "For tracking: rasterised without shadows, with a patterned cloth on the table; no reference pictures");
    synthesize->add_option("--markers", made->markers, "With --quick: what is printed on the paper on the table")
        ->check(CLI::IsMember({"board", "one", "none"}))
        ->needs(quick)
        ->capture_default_str();
    synthesize->add_flag("--apart", made->options.apart, "The camera goes another way around the table");
    synthesize->add_flag("--no-denoise", made->no_denoise, "Do not denoise the frames");
    synthesize->footer(R"(Examples:
  lightwell ar synthesize small_desk --frames 2 --size 160x120 --paths 4 --no-truth
  lightwell ar synthesize one_marker --quick --frames 4 --markers one

After the first frame it says how long the rest will take. The default, 30 frames with references at 640x480 and 4 paths,
takes a minute or two on two cores; its noise is that of a cheap camera. For measurements take --paths 48.)");
    synthesize->callback([made, &exit_code] { exit_code = run_synthesize(*made); });
}

} // namespace viewer
