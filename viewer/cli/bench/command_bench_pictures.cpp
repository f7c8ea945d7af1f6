#include "gi/core/error.h"
#include "gi/methods/registry.h"
#include "viewer/base/arguments.h"
#include "viewer/base/choices.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/validators.h"
#include "viewer/bench/bench_record.h"
#include "viewer/bench/pictures.h"
#include "viewer/bench/sweep_plan.h"
#include "viewer/cli/commands.h"
#include "viewer/report/picture_summary.h"
#include "viewer/report/table_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

int run(PicturesOptions const& o)
{
    PicturesResult const result = o.interactive ? run_interactive_pictures(o) : run_pictures(o);
    if (o.render.json) {
        fmt::print("{{\"pictures\": {}, \"summary\": {}}}\n", to_json(result.pictures), to_json(result.summary));
    } else {
        show(result.pictures, o.out, false);
        std::fputs("\n", stdout);
        show(result.summary, o.out, false);
        for (auto const& [what, value] : result.summary.facts)
            if (what.starts_with("rows that")) fmt::print("{}: {}\n", what, value);
        fmt::print("{}\n", (std::filesystem::path(o.out) / (result.pictures.name + ".html")).string());
    }
    std::fflush(stdout);
    if (!result.interrupted) return 0;
    fmt::print(stderr, "note: interrupted: the rows so far are saved; {}\n",
               o.interactive ? "the same command keeps only the references" : "add --resume to continue");
    return interrupted_code();
}

/// Defaults of moving views, where every frame needs its own reference.
void set_interactive_defaults(CLI::App const& command, PicturesOptions& o)
{
    auto const is_given = [&](char const* name) { return command.get_option(name)->count() > 0; };
    if (!is_given("--methods")) o.methods = {kPeer, "paths"};
    if (!is_given("--denoise")) o.filters = {"none", "atrous"};
    if (!is_given("--size")) o.render.size = "512x512";
    if (!is_given("--reference-paths")) o.reference_paths = 256;
    if (!is_given("--scored-frames")) std::erase_if(o.scored_frames, [&](int f) { return f > o.frames; });
    if (o.resume)
        throw gi::InputError("--resume with --interactive", "a sequence is rendered in one go",
                             "leave --resume out");
}

} // namespace

void add_bench_pictures(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<PicturesOptions>();
    RenderOptions& r = o->render;
    r.size = "256x256";
    r.settings.bounces = 3;
    r.settings.seed = 1;
    CLI::App* const c =
        bench.add_subcommand("pictures", "Compare the pictures of methods over scenes, budgets and filters.");
    auto const list = [&](char const* name, std::vector<std::string>& values, std::string const& help) {
        return c->add_option(name, values, help)->delimiter(',')->capture_default_str()->allow_extra_args(false);
    };
    c->add_option("--list", o->list, "YAML file that names the scenes")->capture_default_str();
    list("--scenes", o->scenes,
         "names in the list, files or built-in scenes, comma-separated (default: all of the list)");
    list("--budgets", o->budgets, "per render, comma-separated: times, or paths per pixel (1path, 16paths)");
    list("--denoise", o->filters, "filters, comma-separated, as for lightwell render --denoise");
    offer(list("--methods", o->methods,
               "comma-separated, as for lightwell bench sweep; all are compared with 'reference'"),
          gi::method_names());
    c->add_option("--repeats", o->repeats, "renders per row, each with its own seed; rows hold medians")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    declare_option(*c, r.settings, "seed")->description("seed of the first repeat");
    c->add_option("--size", r.size, "width x height, pixels")->capture_default_str();
    declare_option(*c, r.settings, "bounces");
    c->add_option("--reference-paths", o->reference_paths, "paths per pixel of the reference pictures")
        ->check(CLI::Range(2, 1 << 24))
        ->capture_default_str();
    c->add_option("--references", o->references,
                  "folder of the reference pictures; existing ones with the same scene and settings are used\n"
                  "(default: DIR/references)");
    constexpr char const* kInteractive = "Interactive frames";
    CLI::Option* const interactive =
        c->add_flag("--interactive", o->interactive,
                    "render the list's sequences instead of its scenes: consecutive frames, with temporal reuse")
            ->excludes("--budgets")
            ->excludes("--repeats")
            ->group(kInteractive);
    auto const of_frames = [&](CLI::Option* option) {
        return option->needs(interactive)->group(kInteractive)->capture_default_str();
    };
    of_frames(c->add_option("--frames", o->frames, "frames of each sequence"))->check(CLI::Range(1, 100000));
    of_frames(c->add_option("--frame-budget", o->frame_budget, "time per render; reuse and filter add to it"));
    of_frames(c->add_option("--reuse", o->reuse, "largest number of frames averaged per pixel; 1 = no reuse"))
        ->check(CLI::Range(1, 1000));
    of_frames(c->add_option("--fps", o->fps, "frames per second of the animation"))->check(in_range(1e-3, 1e6));
    of_frames(c->add_option("--scored-frames", o->scored_frames,
                            "frames to score, counted from 1, comma-separated; rows are\n"
                            "these and their mean"))
        ->delimiter(',')
        ->allow_extra_args(false);
    declare_method_options(*c, r.settings);
    declare_option(*c, r.settings, "threads");
    c->add_option("-o,--out", o->out, "folder for tables, pictures and pictures.html")->required();
    c->add_flag("--resume", o->resume, "keep existing rows in the folder from the same program and settings");
    c->add_flag("--json", r.json, "print both tables as JSON");
    c->add_flag("--quiet", r.quiet, "no progress bar");
    c->footer(fmt::format(R"(Examples:
  lightwell bench pictures --scenes cornell --methods reference,paths --budgets 1path,20ms --repeats 1 --size 32x32 --reference-paths 16 --out pictures
  lightwell bench pictures --scenes cornell --methods reference,paths --budgets 1path,20ms,40ms --repeats 1 --size 32x32 --reference-paths 16 --resume --out pictures
  lightwell bench pictures --scenes atrium --interactive --frames 4 --scored-frames 1,4 --size 24x16 --frame-budget 20ms --reference-paths 4 --out frames

Every render (scene, budget, method, repeat) is filtered by every filter. render_s is the time of the whole call;
it contains structures_s for hit buffers, shadow maps and BVHs, and paths_s for paths and first surfaces. filter_s
is the time of the filter, total_s the sum. relmse does not contain relmse_of_reference, the part caused by noise
of the reference picture. relmse_estimated is the program's own estimate for the unfiltered picture. bias is the
mean divided by that of the reference: of all light, direct light (L1) and indirect light (L2), with standard
errors over the repeats. neighbour_correlation is the correlation between the errors of neighbouring pixels: 0 for
independent noise, near 1 for errors shared by regions.

The summary divides errors and times of each method by those of 'reference'; above an error ratio of {} a row
is lost. Times differ where one path takes longer than the budget. The summary also gives how many times longer
'reference' needs for the same error, filter included, estimated from its errors at all budgets.

--interactive renders consecutive frames, with the same temporal reuse and filters for all methods. Its defaults
are --methods reference,paths --denoise none,atrous --size 512x512 --reference-paths 256. frame_s is the time of
world, render and reuse; in the row 'mean' it is the median of all frames except the first, which builds lasting
structures.

Ctrl-C discards the renders of the current budget, saves the rows so far and exits with 130.)",
                          kLostRatio));
    c->callback([o, c, &exit_code] {
        if (o->interactive) set_interactive_defaults(*c, *o);
        check_sweep_methods(*c, o->render, o->methods);
        exit_code = run(*o);
    });
}

} // namespace viewer
