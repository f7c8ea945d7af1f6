#include "gi/base/error.h"
#include "gi/base/file.h"
#include "gi/base/picture_file.h"
#include "gi/image/tone_map.h"
#include "gi/registry/registry.h"
#include "gi/scene/load.h"
#include "gi/scene/plan.h"
#include "viewer/arguments.h"
#include "viewer/choose_camera.h"
#include "viewer/commands.h"
#include "viewer/interrupt.h"
#include "viewer/report_json.h"
#include "viewer/version.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <unistd.h>

namespace viewer {
namespace {

constexpr std::array<std::string_view, 9> kLayers{"color",  "L0",    "L1",       "L2",      "albedo",
                                                  "normal", "depth", "position", "variance"};
constexpr std::uint32_t kNoLimit = 0x7fffffff;
constexpr int kInterrupted = 130;

struct RenderOptions {
    std::string scene, method = "reference", size = "512x512", camera, look_from, look_at, environment, budget,
                       until, filter = "box", out, png, stats, tone = "srgb";
    std::vector<std::string> layers;
    double fov_deg = 0, time_s = 0, environment_rotate_deg = 0, environment_scale = 1, exposure_ev = 0;
    std::uint32_t paths = 64;
    std::uint64_t seed = 0;
    int bounces = 64, threads = 0;
    bool has_fov = false, has_time = false, has_paths = false, half = false, resume = false, json = false,
         quiet = false;
};

gi::RenderSettings make_settings(RenderOptions const& o)
{
    gi::RenderSettings s;
    std::tie(s.width, s.height) = parse_size(o.size);
    if (int(o.has_paths) + int(!o.budget.empty()) + int(!o.until.empty()) > 1)
        throw gi::InputError("--paths, --budget and --until are given together", "each says alone when to stop",
                             "keep one of them");
    s.paths = o.budget.empty() && o.until.empty() ? o.paths : kNoLimit;
    if (!o.budget.empty()) s.budget_s = parse_duration("--budget", o.budget);
    if (!o.until.empty()) s.until_relmse = parse_target("--until", o.until, "relmse");
    s.bounces = o.bounces;
    s.seed = o.seed;
    s.threads = o.threads;
    s.filter = o.filter == "tent" ? gi::PixelFilter::tent : gi::PixelFilter::box;
    s.resume = o.resume;
    if (!o.out.empty()) s.checkpoint = o.out + ".state";
    return s;
}

/// Finds out before the work whether its result can be kept.
void check_writable(std::string const& file)
{
    if (file.empty()) return;
    std::filesystem::path const path = file, folder = path.has_parent_path() ? path.parent_path() : ".";
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error) || access(folder.c_str(), W_OK) != 0)
        throw gi::InputError("cannot write '" + file + "'",
                             "the folder '" + folder.string() + "' does not exist or is read-only",
                             "create it or choose another");
    if (std::filesystem::is_directory(path, error))
        throw gi::InputError("cannot write '" + file + "'", "it is a folder", "name a file");
}

void say(std::string const& text) { std::fputs(("note: " + text + "\n").c_str(), stderr); }

void set_environment(gi::Scene& scene, RenderOptions const& o, gi::Report& report)
{
    if (!o.environment.empty()) {
        if (scene.environment) say("--envmap replaces the scene's environment map");
        scene.environment = gi::load_environment(o.environment, report);
    }
    if (scene.environment) {
        scene.environment->rotation_rad += float(glm::radians(o.environment_rotate_deg));
        scene.environment->scale *= float(o.environment_scale);
        return;
    }
    bool const lit =
        !scene.lights.empty() || std::any_of(scene.materials.begin(), scene.materials.end(), gi::emits);
    if (lit) return;
    say("the scene has no light: lit by a white sky of radiance 1");
    gi::EnvironmentMap white;
    white.width = 4;
    white.height = 2;
    white.radiance.assign(8, gi::vec3{float(o.environment_scale)});
    scene.environment = white;
}

/// Only what decides the values: not threads, times or names of outputs, so that equal pictures are equal files.
std::map<std::string, std::string> make_metadata(RenderOptions const& o, gi::RenderSettings const& s,
                                                 gi::RenderResult const& result)
{
    std::string command =
        fmt::format("lightwell render {} --method {} --size {}x{} --bounces {} --filter {} --seed {} "
                    "--paths {}",
                    o.scene, o.method, s.width, s.height, s.bounces, o.filter, s.seed, result.paths);
    auto const add = [&](char const* option, std::string const& value) {
        if (!value.empty()) command += fmt::format(" {} {}", option, value);
    };
    add("--camera", o.camera);
    add("--look-from", o.look_from);
    add("--look-at", o.look_at);
    if (o.has_fov) add("--fov", fmt::format("{}", o.fov_deg));
    if (o.has_time) add("--time", fmt::format("{}", o.time_s));
    add("--envmap", o.environment);
    if (o.environment_rotate_deg != 0) add("--envmap-rotate", fmt::format("{}", o.environment_rotate_deg));
    if (o.environment_scale != 1) add("--envmap-scale", fmt::format("{}", o.environment_scale));
    return {{"version", version_number()},
            {"git", git_hash()},
            {"command", command},
            {"scene", o.scene},
            {"method", o.method},
            {"seed", std::to_string(s.seed)},
            {"filter", o.filter},
            {"bounces", std::to_string(s.bounces)},
            {"paths", std::to_string(result.paths)},
            {"units", "radiance, W/(m2 sr), linear Rec. 709"}};
}

void keep_layers(gi::Picture& picture, std::vector<std::string> const& wanted)
{
    if (wanted.empty()) return;
    std::erase_if(picture.layers, [&](gi::Layer const& l) {
        return l.name != "color" && std::find(wanted.begin(), wanted.end(), l.name) == wanted.end();
    });
}

char const* end_text(gi::RenderEnd end)
{
    switch (end) {
    case gi::RenderEnd::paths:
        return "paths";
    case gi::RenderEnd::budget:
        return "budget";
    case gi::RenderEnd::error_target:
        return "error target";
    case gi::RenderEnd::interrupted:
        return "interrupted";
    }
    return "";
}

nlohmann::ordered_json stats(RenderOptions const& o, gi::RenderSettings const& s, gi::ScenePlan const& plan,
                             gi::RenderResult const& r, gi::Report const& report)
{
    nlohmann::ordered_json j;
    j["program"] = version_text();
    j["settings"] = {{"scene", o.scene},     {"method", o.method}, {"width", s.width}, {"height", s.height},
                     {"bounces", s.bounces}, {"filter", o.filter}, {"seed", s.seed},   {"threads", s.threads}};
    j["result"] = {{"end", end_text(r.end)}, {"paths_per_pixel", r.paths},
                   {"seconds", r.seconds},   {"relmse_estimate", r.relmse},
                   {"rays", r.rays},         {"rays_per_s", r.seconds > 0 ? r.rays / r.seconds : 0}};
    for (gi::PlanItem const& item : plan.items)
        j["plan"].push_back({{"what", item.what}, {"build", item.build}, {"reason", item.reason}});
    j["report"] = to_json(report);
    return j;
}

int run(RenderOptions o)
{
    gi::Method const& method = gi::find_method(o.method);
    gi::RenderSettings settings = make_settings(o);
    for (std::string const& layer : o.layers)
        if (std::find(kLayers.begin(), kLayers.end(), layer) == kLayers.end())
            throw gi::InputError("there is no layer '" + layer + "'", "--aovs names layers of the picture",
                                 fmt::format("choose from: {}", fmt::join(kLayers, ", ")));
    CameraChoice choice;
    choice.name = o.camera;
    if (!o.look_from.empty()) choice.look_from = parse_point("--look-from", o.look_from);
    if (!o.look_at.empty()) choice.look_at = parse_point("--look-at", o.look_at);
    if (o.has_fov) choice.fov_deg = o.fov_deg;
    if (o.out.empty() && o.png.empty()) {
        o.out = std::filesystem::path(o.scene).stem().string() + ".exr";
        settings.checkpoint = o.out + ".state";
    }
    for (std::string const& file : {o.out, o.png, o.stats}) check_writable(file);

    gi::Report report;
    gi::Scene scene;
    {
        gi::StageTimer const timer(report, "load");
        scene = gi::load_scene(o.scene, report);
        set_environment(scene, o, report);
    }
    gi::World world;
    {
        gi::StageTimer const timer(report, "world");
        world = gi::build_world(std::make_shared<gi::Scene const>(std::move(scene)),
                                o.has_time ? gi::SceneTime(o.time_s) : std::nullopt, report);
    }
    ChosenCamera const chosen = choose_camera(world, choice);
    if (!chosen.note.empty()) say(chosen.note);

    gi::StopRequest stop;
    gi::RenderResult result;
    {
        InterruptGuard const guard(stop);
        gi::ProgressBar bar("render " + std::filesystem::path(o.scene).filename().string(), !o.quiet);
        result = method.render(
            world, chosen.camera, settings, stop,
            [&](gi::RenderStatus const& s) {
                bar.update(s.fraction, fmt::format("{} paths, relMSE {:.2g}", s.paths, s.relmse));
            },
            report);
    }
    {
        gi::StageTimer const timer(report, "save");
        result.picture.metadata = make_metadata(o, settings, result);
        keep_layers(result.picture, o.layers);
        if (!o.out.empty())
            gi::write_exr(o.out, result.picture, o.half ? gi::PixelType::half : gi::PixelType::single, report);
        if (!o.png.empty()) {
            gi::ToneMapSettings const tone{float(o.exposure_ev),
                                           o.tone == "filmic" ? gi::ToneCurve::filmic : gi::ToneCurve::srgb};
            gi::write_png(o.png, settings.width, settings.height,
                          gi::tone_map_bytes(*result.picture.find("color"), tone));
        }
    }
    nlohmann::ordered_json const j = stats(o, settings, gi::plan_scene(world), result, report);
    if (!o.stats.empty()) gi::write_text(o.stats, to_text(j));
    if (o.json) {
        std::fputs(to_text(j).c_str(), stdout);
    } else {
        for (std::string const& file : {o.out, o.png, o.stats})
            if (!file.empty()) fmt::print("{}\n", file);
        fmt::print("{} x {} pixels, {} paths each, {:.2f} s, {:.2f} Mrays/s, estimated relMSE {:.2g}\n",
                   settings.width, settings.height, result.paths, result.seconds,
                   result.rays / std::max(result.seconds, 1e-9) * 1e-6, result.relmse);
    }
    std::fflush(stdout);
    print_losses(report);
    if (result.end != gi::RenderEnd::interrupted) return 0;
    if (settings.checkpoint.empty())
        say("interrupted: the picture so far is saved; with --out it could be resumed");
    else
        say("interrupted: the picture so far is saved; the same command with --resume goes on");
    return kInterrupted;
}

} // namespace

void add_render(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<RenderOptions>();
    CLI::App* const c = app.add_subcommand("render", "Render a scene to a picture with its error.");
    c->add_option("SCENE", o->scene, "glTF, YAML, OBJ, PLY, FBX, ... file, or atrium, cornell")->required();
    std::string known;
    for (gi::Method const& m : gi::methods()) known += fmt::format("\n  {}: {}", m.name, m.summary);
    c->add_option("--method", o->method, "how light is computed:" + known)->capture_default_str();
    c->add_option("--size", o->size, "width x height, pixels")->capture_default_str();
    c->add_option("--camera", o->camera, "a camera of the scene (default: its first)");
    c->add_option("--look-from", o->look_from, "x,y,z, m");
    c->add_option("--look-at", o->look_at, "x,y,z, m (default: the middle of the scene)");
    CLI::Option const* const fov =
        c->add_option("--fov", o->fov_deg, "vertical field of view, degrees")->check(CLI::Range(0.001, 179.0));
    c->add_option("--envmap", o->environment, "lat-long environment map, HDR or EXR");
    c->add_option("--envmap-rotate", o->environment_rotate_deg, "degrees about +Y, counter-clockwise from above");
    c->add_option("--envmap-scale", o->environment_scale, "factor on its radiance")->check(CLI::Range(0.0, 1e9));
    CLI::Option const* const time = c->add_option("--time", o->time_s, "moment of the animation, s");
    CLI::Option const* const paths =
        c->add_option("--paths", o->paths, "per pixel")->check(CLI::Range(1u, kNoLimit))->capture_default_str();
    c->add_option("--budget", o->budget, "time to trace: 500ms, 2s, 3min");
    c->add_option("--until", o->until, "relmse=E: until the estimated relative error is below");
    c->add_option("--bounces", o->bounces, "indirect bounces; 0 = direct light only")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    c->add_option("--filter", o->filter, "pixel filter")
        ->check(CLI::IsMember({"box", "tent"}))
        ->capture_default_str();
    c->add_option("--seed", o->seed, "another seed, another noise")->capture_default_str();
    c->add_option("--threads", o->threads, "0 = all")->check(CLI::Range(0, 4096))->capture_default_str();
    c->add_option("--out", o->out, "EXR with all layers (default: the scene's name)");
    c->add_flag("--half", o->half, "half floats where they suffice");
    c->add_option("--png", o->png, "tone-mapped picture");
    c->add_option("--exposure", o->exposure_ev, "stops, for --png");
    c->add_option("--tone", o->tone, "curve, for --png")
        ->check(CLI::IsMember({"srgb", "filmic"}))
        ->capture_default_str();
    c->add_option("--aovs", o->layers,
                  fmt::format("layers to keep beside color, of: {}", fmt::join(kLayers, ", ")))
        ->delimiter(',');
    c->add_option("--stats", o->stats, "JSON: times, counts, memory, losses, plan");
    c->add_flag("--resume", o->resume, "go on from F.exr.state");
    c->add_flag("--json", o->json, "print the statistics instead of text");
    c->add_flag("--quiet", o->quiet, "no progress bar");
    c->footer(R"(Examples:
  lightwell render atrium --size 160x100 --paths 16 --png atrium.png --out atrium.exr
  lightwell render atrium --camera courtyard --time 0.4 --size 96x64 --budget 500ms --out walk.exr --stats walk.json
  lightwell render cornell --look-from 0.278,0.273,-0.4 --look-at 0.278,0.2,0.3 --fov 60 --size 64x64 --out close.exr
  lightwell render cornell --until relmse=0.05 --size 48x48 --aovs L1,L2,variance --out cornell.exr)");
    c->callback([o, fov, time, paths, &exit_code] {
        o->has_fov = fov->count() > 0;
        o->has_time = time->count() > 0;
        o->has_paths = paths->count() > 0;
        exit_code = run(*o);
    });
}

} // namespace viewer
