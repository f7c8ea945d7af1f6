#include "gi/base/error.h"
#include "gi/image/compare.h"
#include "gi/image/temporal.h"
#include "gi/registry/registry.h"
#include "gi/scene/generate.h"
#include "gi/scene/generate/figure.h"
#include "viewer/bench/table_file.h"
#include "viewer/bench_record.h"
#include "viewer/commands.h"
#include "viewer/frame_follower.h"
#include "viewer/frame_record.h"
#include "viewer/load_world.h"
#include "viewer/report_json.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>

namespace viewer {
namespace {

using namespace gi;

struct DynamicOptions {
    RenderOptions render;
    std::vector<std::string> scenes, structures{"static", "rebuilt", "appended", "streamed"};
    std::vector<std::uint32_t> triangles;
    std::string out;
    int frames = 24, most_frames = 16;
    double fps = 30;
    std::uint32_t reference_paths = 64;
};

/// What the slhb method does about what moves.
struct Structure {
    std::string_view name;
    Schedule schedule;
    bool moves, anew; ///< time passes; everything is built anew for every frame
};
constexpr Structure kStructures[] = {{"static", Schedule::stored, false, false},
                                     {"rebuilt", Schedule::stored, true, true},
                                     {"appended", Schedule::stored, true, false},
                                     {"temporal", Schedule::temporal, true, false},
                                     {"streamed", Schedule::streamed, true, false}};

Structure const& find_structure(std::string const& name)
{
    std::string known;
    for (Structure const& s : kStructures) {
        if (s.name == name) return s;
        known += (known.empty() ? "" : ", ") + std::string(s.name);
    }
    throw InputError("there is no structure '" + name + "'", "it is not one of slhb's", "choose of: " + known);
}

/// A room with a displaced sphere that stays and a figure of 10,880 triangles that walks.
Scene figure_in_room(std::uint32_t triangles)
{
    Scene scene = generate_sphere(triangles, 0);
    add_figure(scene, glm::translate(dmat4(1), dvec3{3.5, 0, -1.5}), 1);
    return scene;
}

class Dynamic {
public:
    explicit Dynamic(DynamicOptions const& o)
        : o_(o),
          table_(start_table("dynamic", "Frames of what moves, by method slhb: what each costs, and its error",
                             {"scene", "triangles", "moving", "structure", "frame", "time_s", "world_ms",
                              "structures_ms", "shadow_maps_ms", "g_buffer_ms", "direct_ms", "indirect_ms",
                              "reuse_ms", "filter_ms", "frame_ms", "paths", "relmse", "flip"})),
          summary_(start_table("dynamic_summary", "The same, over all frames but the first",
                               {"scene", "triangles", "moving", "structure", "structures_ms", "frame_ms",
                                "frame_ms_p95", "frame_ms_p99", "frame_ms_most", "paths", "relmse", "flip",
                                "flip_most", "not_finite"}))
    {
    }

    void run(std::string const& name, std::shared_ptr<Scene const> scene)
    {
        RenderOptions options = o_.render;
        RenderSettings settings = make_settings(options);
        settings.checkpoint.clear();
        DenoiseSettings const filter = make_denoise_settings(options, settings);
        std::vector<Picture> const references = render_references(scene, settings);
        for (std::string const& structure : o_.structures)
            render(name, scene, find_structure(structure), settings, filter, references);
    }
    BenchTable const& table() const { return table_; }
    BenchTable const& summary() const { return summary_; }
    Report const& report() const { return report_; }

private:
    double time_of(int frame) const { return o_.render.time_s.value_or(0) + frame / o_.fps; }
    Camera camera(World const& world) const { return choose_camera(world, camera_choice(o_.render)).camera; }

    std::vector<Picture> render_references(std::shared_ptr<Scene const> const& scene, RenderSettings s)
    {
        s.paths = o_.reference_paths;
        s.budget_s = 0;
        s.seed += 1000;
        std::vector<Picture> pictures;
        if (o_.reference_paths == 0) return pictures;
        MovingWorld world(scene, time_of(0), report_);
        auto const reference = find_method("reference").frames(world, camera(world.world()), s, report_);
        for (int f = 0; f < o_.frames; ++f) {
            reference->changed(world.advance(time_of(f)));
            Picture p = reference->frame(camera(world.world()), {}, {}).picture;
            std::erase_if(p.layers, [](Layer const& l) { return l.name != "color"; });
            pictures.push_back(std::move(p));
        }
        return pictures;
    }

    void render(std::string const& name, std::shared_ptr<Scene const> const& scene, Structure const& structure,
                RenderSettings settings, DenoiseSettings const& filter, std::vector<Picture> const& references)
    {
        settings.slhb.schedule = structure.schedule;
        if (structure.schedule != Schedule::stored) settings.slhb.directions.clear();
        MovingWorld world(scene, time_of(0), report_);
        auto const start = [&] {
            return find_method("slhb").frames(world, camera(world.world()), settings, report_);
        };
        std::unique_ptr<FrameRenderer> renderer = start();
        TemporalReuse reuse({.most_frames = o_.most_frames});
        ReportReader stages(report_);
        stages.times();
        std::vector<double> frame_s, structures_s, relmse, flip, paths;
        std::ptrdiff_t not_finite = 0;
        double const triangles = double(world.world().triangles.size()),
                     moving = triangles - double(world.world().static_triangles);
        for (int f = 0; f < o_.frames; ++f) {
            RenderResult result;
            Changes changes;
            double world_s = 0, build_s = 0, render_s = 0, reuse_s = 0, filter_s = 0;
            if (structure.moves && f > 0) {
                world_s = seconds_of([&] { changes = world.advance(time_of(f)); });
                build_s = seconds_of([&] {
                    if (structure.anew) {
                        renderer.reset();
                        renderer = start();
                    } else {
                        renderer->changed(changes);
                    }
                });
            }
            Camera const eye = camera(world.world());
            render_s = seconds_of([&] { result = renderer->frame(eye, {}, {}); });
            if (o_.most_frames > 1)
                reuse_s = seconds_of([&] { reuse.add(result.picture, scene_change(changes, f == 0)); });
            filter_s = seconds_of([&] { denoise(result.picture, filter); });

            std::map<std::string, double> spent = stages.times();
            double const in_paths = spent["paths"], direct = spent["direct light, thread seconds"],
                         indirect = spent["indirect light, thread seconds"], light = direct + indirect;
            double const structures = build_s + spent["hit buffers of a pass"];
            double const whole = world_s + build_s + render_s + reuse_s + filter_s;
            std::vector<Cell> row{name,
                                  triangles,
                                  moving,
                                  std::string(structure.name),
                                  double(f),
                                  time_of(f),
                                  1e3 * world_s,
                                  1e3 * structures,
                                  1e3 * spent["shadow maps"],
                                  1e3 * spent["G-buffer"],
                                  1e3 * in_paths * (light > 0 ? direct / light : 0),
                                  1e3 * in_paths * (light > 0 ? indirect / light : 0),
                                  1e3 * reuse_s,
                                  1e3 * filter_s,
                                  1e3 * whole,
                                  double(result.paths)};
            if (references.empty()) {
                row.insert(row.end(), 2, std::monostate{});
            } else {
                Picture const& truth = references[structure.moves ? std::size_t(f) : 0];
                for (NamedValue const& v : compare(result.picture, truth, {"relmse", "flip"}, "color").values) {
                    row.push_back(v.value);
                    if (f > 0) (v.name == "flip" ? flip : relmse).push_back(v.value);
                }
            }
            std::vector<float> const& color = result.picture.find("color")->data;
            not_finite += std::ranges::count_if(color, [](float v) { return !std::isfinite(v); });
            table_.add(row);
            if (f == 0) continue; // it builds what lasts
            frame_s.push_back(whole);
            structures_s.push_back(structures);
            paths.push_back(double(result.paths));
        }
        if (frame_s.empty()) return;
        auto const at = [](std::vector<double> const& v, double share) {
            return v.empty() ? Cell() : Cell(percentile(v, share));
        };
        auto const ms = [&](std::vector<double> const& v, double share) { return 1e3 * percentile(v, share); };
        summary_.add({name, triangles, moving, std::string(structure.name), ms(structures_s, 0.5),
                      ms(frame_s, 0.5), ms(frame_s, 0.95), ms(frame_s, 0.99), ms(frame_s, 1), at(paths, 0.5),
                      at(relmse, 0.5), at(flip, 0.5), at(flip, 1), double(not_finite)});
        write(table_, o_.out);
        write(summary_, o_.out);
    }

    DynamicOptions const& o_;
    BenchTable table_, summary_;
    Report report_;
};

int run(DynamicOptions& o)
{
    check_folder(o.out);
    for (std::string const& s : o.structures) find_structure(s);
    make_folder(o.out);
    o.render.out = "unused";
    o.render.method = "slhb";
    Dynamic bench(o);
    for (std::string const& scene : o.scenes) {
        RenderOptions options = o.render;
        options.scene = scene;
        Report loading;
        bench.run(scene, load_lit_scene(options, loading));
        print_losses(loading);
    }
    for (std::uint32_t const t : o.triangles)
        bench.run(fmt::format("figure in a room of {}", t), std::make_shared<Scene const>(figure_in_room(t)));
    show(bench.table(), o.out, o.render.json);
    if (!o.render.json) show(bench.summary(), o.out, false);
    print_losses(bench.report());
    return 0;
}

} // namespace

void add_bench_dynamic(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<DynamicOptions>();
    o->render.paths = 1;
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
    declare_denoise(*c, o->render);
    declare_slhb(*c, o->render);
    c->add_option("--threads", o->render.threads, "0 = all")->check(CLI::Range(0, 4096))->capture_default_str();
    c->add_option("--out", o->out, "folder for the tables")->required();
    c->add_flag("--json", o->render.json, "print the table as JSON");
    c->footer(R"(Example:
  lightwell bench dynamic --triangles 2000 --frames 3 --size 16x16 --reference-paths 2 --out dynamic

Times are of one frame: world_ms, skinning and what follows from it in the world; structures_ms, hit buffers (rebuilt: all that a renderer starts with);
direct_ms and indirect_ms share the time of the paths as their threads' times do. Errors are against the reference
of the same moment. The summary leaves out the first frame, which builds what lasts; not_finite counts values of all pictures.)");
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace viewer
