#include "gi/core/durable_file.h"
#include "gi/core/error.h"
#include "gi/filter/tone_map.h"
#include "gi/image_io/picture_file.h"
#include "gi/metrics/metrics.h"
#include "viewer/base/arguments.h"
#include "viewer/base/report_json.h"
#include "viewer/bench/bench_record.h"
#include "viewer/bench/bench_session.h"
#include "viewer/cli/commands.h"
#include "viewer/engine/quality.h"
#include "viewer/offline/choose_camera.h"
#include "viewer/report/table_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>

namespace viewer {
namespace {

struct ViewsOptions {
    std::vector<std::string> scenes{"cornell", "atrium"}, settings;
    std::string size = "320x240", out;
    int frames = 24, reference_paths = 512;
    double eye_distance_m = 0.063;
    bool json = false;
};

/// Returns the views of a variant for a camera.
using Views = std::function<std::vector<ViewCommand>(gi::Camera const&)>;

gi::Camera aside(gi::Camera camera, double m)
{
    camera.world_from_camera = camera.world_from_camera * glm::translate(gi::dmat4(1), gi::dvec3{m, 0, 0});
    return camera;
}

/// The user of a CAVE stands inside the scene, so a camera outside of it is moved to its middle.
gi::Camera inside(gi::Camera camera, gi::World const& world)
{
    gi::vec3 const at = gi::vec3(gi::dvec3(camera.world_from_camera[3]) - world.origin);
    gi::Bounds const& b = world.bounds;
    bool const is_inside = glm::all(glm::greaterThan(at, b.low)) && glm::all(glm::lessThan(at, b.high));
    if (!is_inside) camera.world_from_camera[3] = glm::dvec4(gi::dvec3(0.5f * (b.low + b.high)) + world.origin, 1);
    return camera;
}

/// Walls to the left, right, below and in front of the eye, 90 degrees each.
std::vector<ViewCommand> walls(gi::Camera const& eye, int size)
{
    std::vector<ViewCommand> views;
    auto const add = [&](char const* name, double angle, gi::dvec3 axis) {
        gi::Camera wall = eye;
        wall.world_from_camera = eye.world_from_camera * glm::rotate(gi::dmat4(1), angle, axis);
        wall.off_axis = gi::ViewTangents{-1, 1, -1, 1};
        views.push_back({name, wall, size, size, -1});
    };
    add("left", 0.5 * gi::kPi, {0, 1, 0});
    add("right", -0.5 * gi::kPi, {0, 1, 0});
    add("floor", -0.5 * gi::kPi, {1, 0, 0});
    add("front", 0, {0, 1, 0});
    return views;
}

struct ViewVariant {
    std::string name;
    Views views;
    bool in_cave = false;
    std::unique_ptr<gi::Report> report{};
    std::unique_ptr<RenderSession> session{};
    std::vector<double> ms{};
    std::map<std::string, std::vector<double>> stages_ms{};
    SessionFrame last{};
};

void write_picture(gi::Layer const& color, ViewCommand const& view, std::filesystem::path const& file)
{
    gi::write_png(file, view.width, view.height, gi::tone_map_bytes(color, {}));
}

/// relMSE of the last view of a frame against the reference from the same camera; writes both as pictures.
double error_of(RenderSession const& session, FrameCommand const& command, SessionFrame const& frame, int paths,
                std::filesystem::path const& pictures, gi::Report& report)
{
    ViewCommand const& view = command.views.back();
    gi::Layer const right = reference_of(session, view, paths, report);
    gi::Layer const& seen = *frame.views.back().picture.find("color");
    write_picture(seen, view, pictures.string() + ".png");
    write_picture(right, view, pictures.string() + " reference.png");
    return gi::measure_errors(seen.data, right.data, 3).relmse;
}

/// Median time of each stage in the frames of a variant, ms.
std::string stages_of(ViewVariant const& v)
{
    std::string text;
    for (auto const& [stage, ms] : v.stages_ms)
        if (double const median = summarise(ms).median; median >= 0.05)
            text += fmt::format("{}{} {:.3g}", text.empty() ? "" : ", ", stage, median);
    return text;
}

void measure(ViewsOptions const& o, std::string const& scene, BenchTable& table)
{
    auto const [width, height] = parse_size(o.size);
    int const w = width, h = height;
    double const apart = o.eye_distance_m;
    std::vector<ViewVariant> variants;
    variants.push_back({"one view", [=](gi::Camera const& c) {
                            return std::vector<ViewCommand>{{"left", c, w, h, -1}};
                        }});
    variants.push_back({"other eye alone", [=](gi::Camera const& c) {
                            return std::vector<ViewCommand>{{"right", aside(c, apart), w, h, -1}};
                        }});
    for (int const partner : {0, -1})
        variants.push_back(
            {partner == 0 ? "two eyes" : "two eyes, no light shared", [=](gi::Camera const& c) {
                 return std::vector<ViewCommand>{{"left", c, w, h, -1}, {"right", aside(c, apart), w, h, partner}};
             }});
    variants.push_back(
        {"one wall", [=](gi::Camera const& c) { return std::vector<ViewCommand>{walls(c, h).back()}; }, true});
    variants.push_back({"four walls", [=](gi::Camera const& c) { return walls(c, h); }, true});
    std::vector<Change> const settings = parse_changes(o.settings);
    for (ViewVariant& v : variants) {
        v.report = std::make_unique<gi::Report>();
        v.session = bench_session(scene, settings, *v.report);
    }
    gi::Camera const start = choose_camera(variants[0].session->world(), {}).camera;
    gi::Camera const in_cave = inside(start, variants[0].session->world());
    double const step = 0.002 * double(variants[0].session->world().bounds.radius());
    auto const eye = [&](ViewVariant const& v, int f) { return aside(v.in_cave ? in_cave : start, step * f); };
    FrameCommand command;
    for (int f = 0; f < o.frames; ++f) // variants take turns
        for (ViewVariant& v : variants) {
            command.frame = std::uint64_t(f);
            command.scene_s = f / 20.0;
            command.views = v.views(eye(v, f));
            double const s = seconds_of([&] { v.last = v.session->render(command, {}); });
            if (f < 4) continue; // the first frames build lasting structures
            v.ms.push_back(1e3 * s);
            for (auto const& [stage, stage_s] : v.last.stages_s) v.stages_ms[stage].push_back(1e3 * stage_s);
        }
    for (std::size_t k = 0; k < variants.size(); ++k) {
        ViewVariant& v = variants[k];
        command.views = v.views(eye(v, o.frames - 1));
        double const more = double(command.views.size()) - 1;
        // Relative to the single-view variant of the same round.
        std::vector<double> const& first = variants[v.in_cave ? 4 : 0].ms;
        std::vector<double> extra;
        for (std::size_t f = 0; f < v.ms.size(); ++f) extra.push_back((v.ms[f] - first[f]) / std::max(1.0, more));
        table.add({scene, v.name, double(command.views.size()),
                   fmt::format("{}x{}", command.views[0].width, command.views[0].height), summarise(v.ms),
                   more > 0 ? Cell(ratio(extra, first)) : Cell(),
                   error_of(*v.session, command, v.last, o.reference_paths,
                            std::filesystem::path(o.out) /
                                fmt::format("{} {}", std::filesystem::path(scene).stem().string(), v.name),
                            *v.report)});
        print_losses(*v.report);
        table.facts.emplace_back(fmt::format("stages, ms: {}, {}", scene, v.name), stages_of(v));
    }
}

int run(ViewsOptions const& o)
{
    check_folder(o.out);
    gi::make_folder(o.out);
    BenchTable table = start_table(
        "views", "Cost of further views of a frame",
        {"scene", "views", "count", "size", "frame_ms", "each_further_over_first", "relmse_of_last_view"});
    for (std::string const& scene : o.scenes) {
        measure(o, scene, table);
        write(table, o.out);
    }
    show(table, o.out, o.json);
    return 0;
}

} // namespace

void add_bench_views(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<ViewsOptions>();
    CLI::App* const c =
        bench.add_subcommand("views", "Measure the cost of a second eye and further walls, with their error.");
    c->add_option("--scene", o->scenes, "files or names, comma-separated")
        ->delimiter(',')
        ->capture_default_str()
        ->allow_extra_args(false);
    c->add_option("--set", o->settings, "KEY=VALUE as for view; repeatable")->take_all();
    c->add_option("--size", o->size, "of an eye, pixels; walls are square, of its height")->capture_default_str();
    c->add_option("--frames", o->frames, "frames per variant, the first 4 are not timed; the camera moves")
        ->check(CLI::Range(8, 10000))
        ->capture_default_str();
    c->add_option("--eye-distance", o->eye_distance_m, "distance of the eyes, m")->capture_default_str();
    c->add_option("--reference-paths", o->reference_paths, "paths per pixel")->capture_default_str();
    c->add_option("-o,--out", o->out, "folder for views.json, views.csv and pictures")->required();
    c->add_flag("--json", o->json, "print the table as JSON");
    c->footer(R"(Example:
  lightwell bench views --scene cornell --size 48x36 --frames 8 --reference-paths 16 --out views

Frames are rendered as in view, with reuse and filter, while the camera moves; variants take turns. relMSE is that
of the last view in the last frame.)");
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace viewer
