#include "viewer/base/report_json.h"
#include "viewer/bench/bench_record.h"
#include "viewer/bench/dynamic.h"
#include "viewer/bench/dynamic_sequence.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <memory>

namespace viewer {
namespace {

int run(DynamicOptions& o)
{
    o.render.out = "unused";
    o.render.method = "slhb";
    if (o.render.budget.empty()) o.render.paths = 1;
    gi::Report report;
    DynamicResult const result = run_dynamic(o, report);
    show(result.frames, o.out, o.render.json);
    if (!o.render.json) show(result.summary, o.out, false);
    print_losses(report);
    return 0;
}

} // namespace

void add_bench_dynamic(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<DynamicOptions>();
    o->render.settings.bounces = 2;
    o->render.denoise = "discontinuity";
    CLI::App* const c = bench.add_subcommand("dynamic", "Measure the cost of each part of moving frames.");
    auto const list = [&](char const* name, auto& values, char const* help) {
        c->add_option(name, values, help)->delimiter(',')->allow_extra_args(false);
    };
    auto const number = [&](char const* name, auto& value, int low, int high, char const* help) {
        c->add_option(name, value, help)->check(CLI::Range(low, high))->capture_default_str();
    };
    list("--scene", o->scenes, "files or names, comma-separated");
    list("--triangles", o->triangles, "triangles of rooms in which a figure walks, comma-separated");
    list("--structures", o->structures,
         "comma-separated, of: static (nothing moves), rebuilt (all hit buffers in every frame), appended (moving "
         "triangles to static ones), temporal, streamed");
    c->add_option("--size", o->render.size, "width x height, pixels")->capture_default_str();
    declare_view_options(*c, o->render);
    number("--frames", o->frames, 2, 100000, "number of frames for each structure");
    c->add_option("--fps", o->fps, "frames per second of the animation")
        ->check(CLI::Range(1e-3, 1e6))
        ->capture_default_str();
    c->add_option("--budget", o->render.budget,
                  "time per frame, without reuse and filter (default: one path per pixel)");
    declare_option(*c, o->render.settings, "bounces");
    number("--reuse", o->most_frames, 1, 1000,
           "largest number of frames averaged per pixel; 1 = no temporal reuse");
    number("--reference-paths", o->reference_paths, 0, 1 << 24, "paths per pixel and frame; 0 = no errors");
    number("--seeds", o->seeds, 1, 64, "number of sequences; 4 or more separate the lag of reuse from noise");
    declare_denoise(*c, o->render);
    declare_method_options(*c, o->render.settings, {"slhb"}, {"schedule"}); // which --structures sets
    declare_option(*c, o->render.settings, "threads");
    c->add_option("-o,--out", o->out, "folder for the tables")->required();
    c->add_flag("--json", o->render.json, "print the table as JSON");
    c->footer(R"(Example:
  lightwell bench dynamic --triangles 2000 --frames 3 --size 16x16 --reference-paths 2 --out dynamic

Times are per frame. world_ms: skinning and the resulting updates of the world. structures_ms: hit buffers
(rebuilt: everything that a renderer builds at its start). direct_ms and indirect_ms: the time of the paths,
divided in proportion to their thread times. Errors are against the reference of the same moment; _alone: of the
same frames without reuse. lag_relmse: error added by reuse apart from noise, from several seeds. The summary
leaves out the first frame, which builds lasting structures. In the summary, memory_MiB is that of the last frame,
with its range from frame 100 on; raised counts frames with more error than without reuse; not_finite counts values
in all pictures. The last frame is saved as a picture, with its FLIP map.)");
    c->callback([o, c, &exit_code] {
        std::vector<gi::ChosenMethod> methods;
        for (std::string const& s : o->structures) {
            methods.push_back({"slhb", o->render.settings, "--structures " + s});
            methods.back().settings.of<gi::SlhbSettings>().schedule = find_structure(s).schedule;
        }
        check_method_options(*c, methods);
        exit_code = run(*o);
    });
}

} // namespace viewer
