#include "gi/methods/registry.h"
#include "gi/scene/load/load.h"
#include "viewer/base/choices.h"
#include "viewer/base/interrupt.h"
#include "viewer/bench/bench_record.h"
#include "viewer/bench/sweep.h"
#include "viewer/bench/sweep_plan.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

int run(SweepOptions const& o)
{
    SweepResult const result = run_sweep(o);
    show(result.table, o.out, o.render.json);
    if (!result.interrupted) return 0;
    std::fputs("note: interrupted: the rows so far are saved; the same command starts again, but keeps the "
               "reference pictures\n",
               stderr);
    return interrupted_code();
}

} // namespace

void add_bench_sweep(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<SweepOptions>();
    std::string known;
    for (gi::Method const& m : gi::methods()) {
        o->methods.emplace_back(m.name);
        known += fmt::format("\n  {}: {}", m.name, m.summary);
    }
    o->budgets = {"30ms", "100ms", "300ms", "1s", "3s", "10s"};
    CLI::App* const c = bench.add_subcommand("sweep", "Compare the errors of methods at equal time budgets.");
    auto const list = [&](char const* name, std::vector<std::string>& values, std::string const& help) {
        return c->add_option(name, values, help)->delimiter(',')->allow_extra_args(false);
    };
    offer(list("--scene", o->scenes, "files or names, comma-separated"), gi::built_in_scenes())->required();
    offer(list("--methods", o->methods,
               "comma-separated; methods:" + known +
                   "\n  slhb:auto, slhb:stored, slhb:streamed, slhb:temporal: slhb with this schedule"
                   "\n  vpl_imperfect:30%, vpl_slhb:icosahedron:80, vpl_ao:0.5, vpl_dao:0.5: with these points, "
                   "directions, radius (m)"),
          gi::method_names())
        ->capture_default_str();
    list("--budgets", o->budgets, "times for a frame, comma-separated")->capture_default_str();
    RenderOptions& r = o->render;
    c->add_option("--size", r.size, "width x height, pixels")->capture_default_str();
    declare_view_options(*c, r);
    declare_lens_options(*c, r);
    declare_option(*c, r.settings, "bounces");
    CLI::Option* const paths = c->add_option("--reference-paths", o->reference_paths,
                                             "paths per pixel of the reference picture, which is kept in DIR")
                                   ->check(CLI::Range(2, 1 << 24))
                                   ->capture_default_str();
    c->add_option("--reference", o->reference, "picture to use as reference; for one scene")->excludes(paths);
    c->add_option("--repeats", o->repeats, "renders per row, each with its own seed; rows hold medians")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    declare_denoise(*c, r);
    declare_method_options(*c, r.settings);
    declare_option(*c, r.settings, "threads");
    c->add_option("-o,--out", o->out, "folder for sweep.json, sweep.csv and the pictures")->required();
    c->add_flag("--json", r.json, "print the table as JSON");
    c->add_flag("--quiet", r.quiet, "no progress bar");
    c->footer(R"(Examples:
  lightwell bench sweep --scene cornell --methods reference --budgets 20ms --repeats 2 --size 32x32 --reference-paths 32 --out sweep
  lightwell bench sweep --scene cornell,atrium --methods slhb:stored,slhb:streamed --budgets 20ms --repeats 1 --size 24x24 --reference-paths 8 --out both --json
  lightwell bench sweep --scene cornell --methods vpl_exact,vpl_slhb,vpl_imperfect:30%,vpl_imperfect:5%,vpl_ao:0.1,vpl_dao:0.1,vpl_none --light-paths 64 --budgets 20ms --repeats 1 --size 24x24 --reference-paths 8 --out visibility

Columns: budget_s, the requested time for structures, paths and filter together; frame_s, the time of the whole
call, with all that the method builds for it (it may exceed the budget, as at least one path per pixel is
finished); trace_s, the time of tracing alone; paths per pixel; Mrays_per_s; relmse (relmse_indirect: of L2 alone),
flip and bias against the reference, which has its own seed; reference_relmse, the part of relmse caused by noise
of the reference.

Ctrl-C discards the current render, saves the rows so far and exits with 130; a second one ends at once.)");
    c->callback([o, c, &exit_code] {
        check_sweep_methods(*c, o->render, o->methods);
        exit_code = run(*o);
    });
}

} // namespace viewer
