#include "viewer/base/choices.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/report_json.h"
#include "viewer/base/validators.h"
#include "viewer/bench/bench_record.h"
#include "viewer/bench/shown/head_path.h"
#include "viewer/bench/shown/shown_bench.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"

#include "gi/scene/load/load.h"

#include <CLI/CLI.hpp>
#include <memory>

namespace viewer {

void add_bench_shown(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<ShownOptions>();
    CLI::App* const c = bench.add_subcommand("shown", about("bench shown"));
    offer(c->add_option("scene", o->scene.scene, "scene file or name of a generated scene, as for render"),
          gi::built_in_scenes())
        ->required();
    declare_view_options(*c, o->scene);
    offer(c->add_option("--head", o->head,
                        "recorded path: a name, or CSV (time_s,x_m,y_m,z_m,yaw_deg,pitch_deg; right, up, back)"),
          head_path_names())
        ->capture_default_str();
    c->add_option("--size", o->size, "width x height of an eye's picture, pixels")->capture_default_str();
    c->add_option("--eyes", o->eyes, "1, or 2 that are 0.063 m apart")
        ->check(CLI::Range(1, 2))
        ->capture_default_str();
    c->add_option("--avatar", o->avatar, "skinned model, or avatar (built in), that follows the head");
    c->add_option("--set", o->settings, "KEY=VALUE of the viewer, e.g. draw_surfaces=false; repeatable")
        ->take_all();
    c->add_option("--at", o->changes,
                  "SECONDS:KEY=VALUE: what changes on the path, e.g. 3:light.all.scale=0; repeatable")
        ->take_all();
    c->add_option("--changes", o->changes_file, "text file with such changes, one a line; comments begin with #");
    c->add_option("--moments", o->moments, "moments whose pictures are compared; 0 = none")
        ->check(CLI::Range(0, 10000))
        ->capture_default_str();
    c->add_option("--truth-paths", o->truth_paths, "paths per pixel of the converged pictures")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    c->add_option("--truth-filter", o->truth_filter, "their filter, as --denoise of render")
        ->capture_default_str();
    c->add_option("-o,--out", o->out, "folder for the table and the pictures")->required();
    c->add_flag("--json", o->scene.json, "print the table as JSON");
    c->footer(
        R"(The viewer runs without a window, in real time, while the head moves; the first second of its path is not
scored. Compared is what is still on the screen at a moment with a converged picture of that moment, so the age of
poses and light counts. interval: time between two pictures while the head moves or changes go on; rendering:
between two pictures of light; light_age: since the pose for which the light was rendered; still_flicker: root mean square of what
changes between two pictures from 2 s after the path on, when head and clips stand, most of them, in steps of 1/255; rivalry: mean difference of the
eyes' errors at points that both see, in the same steps; response: time after the first change of --at until the mean
of what is shown has made 90 % of its way to where it is 2.5 s later; unlit_share: share of the pixels of surfaces
that no picture of light shows, lit by cells of space or by the mean; unlit_error: mean difference there over the mean
of the converged picture there, both as the display emits them.

Example:
  lightwell bench shown cornell --size 320x240 --moments 2 --truth-paths 4 --out shown)");
    c->callback([o, &exit_code] {
        gi::Report report;
        gi::StopRequest stop;
        InterruptGuard const guard(stop);
        show(run_shown(*o, stop, report), o->out, o->scene.json);
        print_losses(report);
        exit_code = was_interrupted() ? interrupted_code() : 0;
    });
}

} // namespace viewer
