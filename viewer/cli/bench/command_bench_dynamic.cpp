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
    o->render.bounces = 2;
    o->render.denoise = "discontinuity";
    CLI::App* const c = bench.add_subcommand("dynamic", "Frames of what moves: what each part of them costs.");
    auto const list = [&](char const* name, auto& values, char const* help) {
        c->add_option(name, values, help)->delimiter(',')->allow_extra_args(false);
    };
    auto const number = [&](char const* name, auto& value, int low, int high, char const* help) {
        c->add_option(name, value, help)->check(CLI::Range(low, high))->capture_default_str();
    };
    list("--scene", o->scenes, "files or names, comma-separated");
    list("--triangles", o->triangles, "rooms of so many triangles, in which a figure walks, comma-separated");
    list("--structures", o->structures,
         "comma-separated, of: static (nothing moves), rebuilt (all hit buffers, in every frame), appended (what "
         "moves to what stays), temporal, streamed");
    c->add_option("--size", o->render.size, "width x height, pixels")->capture_default_str();
    declare_view_options(*c, o->render);
    number("--frames", o->frames, 2, 100000, "of each structure");
    c->add_option("--fps", o->fps, "frames per second of the animation")
        ->check(CLI::Range(1e-3, 1e6))
        ->capture_default_str();
    c->add_option("--budget", o->render.budget,
                  "time for a frame, less reuse and filter (default: one path per pixel)");
    number("--bounces", o->render.bounces, 0, 1000, "indirect bounces");
    number("--reuse", o->most_frames, 1, 1000,
           "frames that a pixel is the mean of at most; 1 = no temporal reuse");
    number("--reference-paths", o->reference_paths, 0, 1 << 24, "per pixel and frame; 0 = no errors");
    number("--seeds", o->seeds, 1, 64, "sequences; from 4 on the lag of reuse is told from noise");
    declare_denoise(*c, o->render);
    declare_slhb(*c, o->render);
    c->remove_option(c->get_option("--schedule")); // --structures say it
    c->add_option("--threads", o->render.threads, "0 = all")->check(CLI::Range(0, 4096))->capture_default_str();
    c->add_option("--out", o->out, "folder for the tables")->required();
    c->add_flag("--json", o->render.json, "print the table as JSON");
    c->footer(R"(Example:
  lightwell bench dynamic --triangles 2000 --frames 3 --size 16x16 --reference-paths 2 --out dynamic

Times are of one frame: world_ms, skinning and what follows from it in the world; structures_ms, hit buffers
(rebuilt: all that a renderer starts with); direct_ms and indirect_ms share the time of the paths as their threads'
times do. Errors are against the reference of the same moment; _alone: of the same frames without reuse. lag_relmse:
error that reuse adds apart from noise, from several seeds. The summary leaves out the first frame, which builds what
lasts; memory_MiB there is that of the last frame, with what was seen from frame 100 on; raised counts frames with
more error than alone; not_finite, values of all pictures. The last frame is kept as a picture, with its FLIP.)");
    c->callback([o, c, &exit_code] {
        std::vector<NamedMethod> methods;
        for (std::string const& s : o->structures)
            methods.push_back({"slhb", find_structure(s).schedule, "--structures " + s});
        check_slhb(*c, methods);
        exit_code = run(*o);
    });
}

} // namespace viewer
