#include "gi/image/metrics.h"
#include "gi/registry/registry.h"
#include "viewer/bench/table_file.h"
#include "viewer/bench_record.h"
#include "viewer/commands.h"
#include "viewer/load_world.h"
#include "viewer/report_json.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

using namespace gi;

struct AccuracyOptions {
    RenderOptions render;
    std::vector<std::string> scenes{"cornell", "atrium"}, directions{"icosahedron:80", "icosahedron:320"};
    std::vector<int> resolutions{32, 64, 128, 256, 512};
    std::uint32_t paths = 512, reference_paths = 4096;
    std::string out;
};

/// Mean of a layer over the mean of the reference's, and the relMSE of the layer.
ErrorSums layer_errors(Picture const& picture, Picture const& reference, char const* layer)
{
    return measure_errors(picture.find(layer)->data, reference.find(layer)->data, 3);
}

int run(AccuracyOptions& o)
{
    check_folder(o.out);
    make_folder(o.out);
    BenchTable table = start_table("accuracy", "Bias of indirect light against the reference",
                                   {"scene", "schedule", "directions", "hit_buffer", "bias_direct",
                                    "bias_indirect", "relmse_indirect", "seconds"});
    o.render.out = "unused";
    StopRequest const stop;
    Report report;
    for (std::string const& scene : o.scenes) {
        RenderOptions options = o.render;
        options.scene = scene;
        World const world = load_world(options, report);
        Camera const camera = choose_camera(world, camera_choice(options)).camera;
        options.paths = o.reference_paths;
        options.seed = 1000;
        RenderSettings s = make_settings(options);
        s.checkpoint.clear();
        Picture const reference = find_method("reference").render(world, camera, s, stop, {}, report).picture;
        s.paths = o.paths;
        s.seed = 1;
        auto const row = [&](Schedule schedule, std::string const& directions, int resolution) {
            s.slhb = options.slhb;
            s.slhb.schedule = schedule;
            s.slhb.directions = directions;
            s.slhb.resolution = resolution;
            RenderResult const r = find_method("slhb").render(world, camera, s, stop, {}, report);
            ErrorSums const indirect = layer_errors(r.picture, reference, "L2");
            table.add({scene, std::string(schedule == Schedule::stored ? "stored" : "streamed"),
                       directions.empty() ? std::string("all") : directions, double(resolution),
                       layer_errors(r.picture, reference, "L1").mean_bias - 1, indirect.mean_bias - 1,
                       indirect.relmse, r.seconds});
            write(table, o.out);
        };
        for (int const resolution : o.resolutions) {
            for (std::string const& directions : o.directions) row(Schedule::stored, directions, resolution);
            row(Schedule::streamed, "", resolution);
        }
    }
    table.facts = {{"size", o.render.size},
                   {"bounces", std::to_string(o.render.bounces)},
                   {"paths", std::to_string(o.paths)},
                   {"reference", fmt::format("path tracing, {} paths per pixel", o.reference_paths)}};
    write(table, o.out);
    show(table, o.out, o.render.json);
    print_losses(report);
    return 0;
}

} // namespace

void add_bench_accuracy(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<AccuracyOptions>();
    o->render.size = "64x64";
    o->render.bounces = 2;
    CLI::App* const c =
        bench.add_subcommand("accuracy", "Bias of slhb by directions and texels of its hit buffers.");
    auto const list = [&](char const* name, auto& values, char const* help) {
        c->add_option(name, values, help)->delimiter(',')->capture_default_str()->allow_extra_args(false);
    };
    list("--scene", o->scenes, "files or names, comma-separated");
    list("--directions", o->directions, "of the stored schedule, comma-separated");
    list("--hit-buffers", o->resolutions, "texels on a side, comma-separated");
    declare_view_options(*c, o->render);
    c->add_option("--size", o->render.size, "width x height, pixels")->capture_default_str();
    c->add_option("--bounces", o->render.bounces, "indirect bounces")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    c->add_option("--paths", o->paths, "per pixel")->check(CLI::Range(1u, 1u << 24))->capture_default_str();
    c->add_option("--reference-paths", o->reference_paths, "per pixel, of the reference")
        ->check(CLI::Range(1u, 1u << 24))
        ->capture_default_str();
    c->add_option("--threads", o->render.threads, "0 = all")->check(CLI::Range(0, 4096))->capture_default_str();
    declare_slhb_quality(*c, o->render);
    c->add_option("--out", o->out, "folder for accuracy.json and accuracy.csv")->required();
    c->add_flag("--json", o->render.json, "print the table as JSON");
    c->footer(R"(Example:
  lightwell bench accuracy --scene cornell --directions icosahedron:80 --hit-buffers 32 --size 16x16 --paths 16 --reference-paths 32 --out accuracy

bias_direct and bias_indirect are mean(picture) / mean(reference) - 1 of the layers L1 and L2 over all channels.)");
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace viewer
