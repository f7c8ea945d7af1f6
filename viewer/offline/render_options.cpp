#include "viewer/offline/render_options.h"

#include "gi/core/error.h"
#include "gi/filter/filter_names.h"
#include "gi/kernel/device.h"
#include "gi/methods/registry.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/camera.h"
#include "viewer/base/arguments.h"
#include "viewer/base/choices.h"
#include "viewer/base/validators.h"
#include "viewer/offline/frame_options.h"
#include "viewer/offline/scene_light.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace viewer {
namespace {

constexpr std::array<std::string_view, 9> kLayers{"color",  "L0",    "L1",       "L2",      "albedo",
                                                  "normal", "depth", "position", "variance"};
constexpr std::uint32_t kDefaultPaths = 64, kNoLimit = 0x7fffffff;

void check_shutter(RenderOptions const& o, gi::RenderSettings const& s)
{
    if (!o.time_s && o.frames.empty())
        throw gi::InputError("--shutter without --time or --frames", "its opening time is not known",
                             "add --time 0 or --frames 0:24@24");
    if (o.reuse > 1)
        throw gi::InputError("--shutter with --reuse", "motion vectors connect single moments",
                             "keep one of them");
    if (s.resume)
        throw gi::InputError("--shutter with --resume", "a picture with motion blur is rendered in one go",
                             "leave --resume out");
}

/// Sets where and how often the state of a single picture is kept.
void set_checkpoints(RenderOptions const& o, gi::RenderSettings& s)
{
    bool const is_kept = o.frames.empty() && o.shutter_s == 0;
    if (!is_kept && !o.state.empty())
        throw gi::InputError(o.frames.empty() ? "--state with --shutter" : "--state with --frames",
                             o.frames.empty() ? "a picture with motion blur is rendered in one go"
                                              : "each complete frame is kept, and --resume renders the others",
                             "leave --state out");
    s.checkpoint_s = o.checkpoint == "off" ? 0 : parse_duration("--checkpoint", o.checkpoint);
    std::string const& picture = o.out.empty() ? o.png : o.out;
    if (!o.state.empty())
        s.checkpoint = o.state;
    else if (is_kept && !picture.empty())
        s.checkpoint = picture + ".state";
}

/// File name from the name of the scene, which may be a folder with a trailing slash.
std::string default_out(std::string const& scene, char const* ending)
{
    std::filesystem::path const path = std::filesystem::absolute(scene).lexically_normal();
    return (path.has_filename() ? path : path.parent_path()).stem().string() + ending;
}

} // namespace

gi::RenderSettings make_settings(RenderOptions& o)
{
    if (int(o.paths.has_value()) + int(!o.budget.empty()) + int(!o.until.empty()) > 1)
        throw gi::InputError("--paths, --budget and --until are given together", "each alone says when to stop",
                             "keep one of them");
    for (std::string const& layer : o.layers)
        if (std::find(kLayers.begin(), kLayers.end(), layer) == kLayers.end())
            throw gi::InputError("there is no layer '" + layer + "'", "the picture has no such layer",
                                 fmt::format("choose from: {}", fmt::join(kLayers, ", ")));
    bool const is_sequence = !o.frames.empty();
    if (o.out.empty() && o.png.empty() && o.video.empty())
        o.out = default_out(o.scene, is_sequence ? "_%04d.exr" : ".exr");
    if (o.out.empty() && (o.half || !o.layers.empty() || (o.resume && is_sequence)))
        throw gi::InputError(is_sequence ? "--resume, --half and --aovs need an EXR output"
                                         : "--half and --aovs need an EXR output",
                             "none is saved", is_sequence ? "add --out f_%04d.exr" : "add --out F.exr");

    gi::RenderSettings s = o.settings;
    std::tie(s.width, s.height) = parse_size(o.size);
    gi::check_picture_size(s.width, s.height);
    s.paths = o.budget.empty() && o.until.empty() ? o.paths.value_or(kDefaultPaths) : kNoLimit;
    if (!o.budget.empty()) s.budget_s = parse_duration("--budget", o.budget);
    if (!o.until.empty()) s.until_relmse = parse_target("--until", o.until, "relmse");
    gi::check_device(s.space);
    s.resume = o.resume && !is_sequence; // a sequence is resumed frame by frame
    if (o.shutter_s > 0) check_shutter(o, s);
    set_checkpoints(o, s);
    return s;
}

gi::DenoiseSettings make_denoise_settings(RenderOptions const& o, gi::RenderSettings const& s)
{
    gi::DenoiseSettings d = gi::find_filter(o.denoise);
    gi::check_filter(d, s.paths, o.reuse > 1);
    d.threads = s.threads;
    return d;
}

void declare_view_options(CLI::App& c, RenderOptions& o)
{
    c.add_option("--camera", o.camera, "name of a camera of the scene (default: its first)");
    c.add_option("--look-from", o.look_from, "position of the camera, x,y,z, m");
    c.add_option("--look-at", o.look_at, "point to look at, x,y,z, m (default: middle of the scene)");
    c.add_option("--fov", o.fov_deg, "vertical field of view, degrees")->check(in_range(0.001, 179));
    c.add_option("--envmap", o.environment, "lat-long environment map, HDR or EXR");
    c.add_option("--envmap-rotate", o.environment_rotate_deg,
                 "turns the map about +Y, degrees, counter-clockwise from above, besides the scene's own rotation")
        ->check(in_range(-1e6, 1e6));
    c.add_option("--envmap-scale", o.environment_scale, "scale factor of its radiance")->check(in_range(0, 1e9));
    c.add_option(
         "--light", o.light,
         "what a scene without light gets: studio (lamps before a grey background, also where nothing but\n"
         "textures glow), white (a sky of radiance 1) or none")
        ->check(CLI::IsMember(std::vector<std::string>(kLightChoices.begin(), kLightChoices.end())))
        ->capture_default_str();
    c.add_option("--time", o.time_s, "animation time, s")->check(in_range(-1e9, 1e9));
}

void declare_lens_options(CLI::App& c, RenderOptions& o)
{
    c.add_option("--aperture-radius", o.aperture_radius_m,
                 "radius of a thin lens, m, for depth of field (default: the camera's, else 0, a pinhole)")
        ->check(in_range(0, gi::kWidestLens_m));
    c.add_option(
         "--focus-distance", o.focus_distance_m,
         "distance of the plane in focus along the view, m; needs an aperture radius above 0 (default: the\n"
         "camera's, else the distance of the point of --look-at, else of the middle of the scene)")
        ->check(in_range(gi::kNearestFocus_m, gi::kFarthestFocus_m));
}

void declare_eye_options(CLI::App& c, RenderOptions& o)
{
    CLI::Option* const eye =
        c.add_option("--eye", o.eye,
                     "render one eye of a stereo pair, left or right: beside the camera, with an off-axis view\n"
                     "of a virtual screen that both eyes share")
            ->check(CLI::IsMember({"left", "right"}));
    c.add_option("--eye-distance", o.eye_distance_m, "distance between the pupils, m")
        ->check(in_range(0, 1))
        ->capture_default_str()
        ->needs(eye);
    c.add_option(
         "--screen-distance", o.screen_distance_m,
         "distance of the virtual screen along the view, m; the two pictures coincide there (default: that of\n"
         "the middle of the scene)")
        ->check(in_range(0.01, 1e6))
        ->needs(eye);
}

void declare_denoise(CLI::App& c, RenderOptions& o)
{
    std::string known;
    for (gi::NamedFilter const& f : gi::named_filters())
        if (*f.meaning != 0) known += fmt::format("\n  {}: {}", f.name, f.meaning);
    c.add_option(
         "--denoise", o.denoise,
         "edge-preserving filter of the finished picture; changes color, L1 and L2, but not the variance and "
         "the estimated error:" +
             known)
        ->check(CLI::IsMember(gi::filter_names()))
        ->capture_default_str();
}

void declare_pixels(CLI::App& c, RenderOptions& o, std::string const& shown)
{
    c.add_flag("--half", o.half, "16-bit floats for layers for which they suffice");
    c.add_option("--png", o.png, "PNG file for the tone-mapped picture, .png");
    c.add_option("--exposure", o.exposure_ev, "in stops, for " + shown)->check(in_range(-100, 100));
    c.add_option("--tone", o.tone, "tone curve, for " + shown)
        ->check(CLI::IsMember({"srgb", "filmic"}))
        ->capture_default_str();
}

CLI::Option* declare_option(CLI::App& c, gi::RenderSettings& settings, std::string_view name)
{
    gi::RenderOption const& o = gi::render_option(name);
    std::string names = "--" + o.name;
    for (std::string const& former : o.former) names += ",--" + former;
    std::ranges::replace(names, '_', '-');
    auto const set = [&settings, &o](std::string const& text) {
        o.set(settings, text, fmt::format("--{} {}", o.name, text));
    };
    CLI::Option* const option =
        o.type == gi::OptionType::yes_or_no
            ? c.add_flag_callback(
                  names, [set] { set("true"); }, o.meaning)
            : c.add_option_function<std::string>(names, set, o.meaning)->type_name("[" + o.values_text() + "]");
    if (o.name == "threads") option->transform(as_many_threads_as_there_are());
    if (!o.group.empty()) option->group(o.replaced_by.empty() ? o.group : "");
    bool const explains_default = o.meaning.find("(default") != std::string::npos;
    if (o.type != gi::OptionType::yes_or_no && !explains_default) option->default_str(o.get(settings));
    return option;
}

void declare_method_options(CLI::App& c, gi::RenderSettings& settings,
                            std::vector<std::string_view> const& methods,
                            std::vector<std::string_view> const& except)
{
    for (gi::RenderOption const& o : gi::render_options()) {
        bool const is_read =
            methods.empty() || std::ranges::any_of(methods, [&](std::string_view m) { return o.read_by(m); });
        if (!o.methods.empty() && is_read && std::ranges::find(except, o.name) == except.end())
            declare_option(c, settings, o.name);
    }
}

void check_method_options(CLI::App const& command, std::vector<gi::ChosenMethod> const& methods)
{
    std::vector<std::string> given;
    for (gi::RenderOption const& o : gi::render_options()) {
        CLI::Option const* const option = command.get_option_no_throw("--" + o.name);
        if (option != nullptr && option->count() > 0) given.push_back(o.name);
    }
    gi::check_options(given, methods);
}

void declare_options(CLI::App& c, RenderOptions& o)
{
    offer(c.add_option("SCENE", o.scene,
                       "glTF, YAML, OBJ, PLY, FBX, ... file, a folder of OBJ or PLY frames, or atrium, cornell, "
                       "mirror, ring, avatar"),
          gi::built_in_scenes())
        ->required();
    std::string known;
    for (gi::Method const& m : gi::methods())
        if (m.offered) known += fmt::format("\n  {}: {}", m.name, m.summary);
    offer(c.add_option("--method", o.method, "light transport method:" + known), gi::method_names())
        ->capture_default_str();
    c.add_option("--size", o.size, "width x height, pixels")->capture_default_str();
    declare_view_options(c, o);
    declare_lens_options(c, o);
    declare_eye_options(c, o);
    c.add_option(
        "--background", o.background,
        "what the camera sees behind all surfaces (default: that of the scene, else map):"
        "\n  map: the environment map, black without one"
        "\n  R,G,B: a colour, radiance"
        "\n  transparent: nothing; adds an alpha channel A, the share of paths that hit a surface; colours are "
        "premultiplied by it in --out but not in --png"
        "\nAffects only camera rays: surfaces are lit by the map, and mirrors and glass show it, as surfaces "
        "of alpha 1");
    c.add_option("--paths", o.paths, fmt::format("paths per pixel (default {})", kDefaultPaths))
        ->check(CLI::Range(1u, kNoLimit));
    c.add_option("--budget", o.budget,
                 "time for structures and paths: 500ms, 2s, 3min; loading, filters and writing come on top");
    c.add_option("--until", o.until, "relmse=E: render until the estimated relMSE is below E");
    declare_option(c, o.settings, "bounces");
    declare_option(c, o.settings, "filter");
    declare_denoise(c, o);
    declare_option(c, o.settings, "seed");
    declare_option(c, o.settings, "threads");
    c.add_option("-o,--out", o.out, "EXR file for all layers, .exr (default: the scene's name)");
    declare_pixels(c, o, "--png and --video");
    c.add_option("--aovs", o.layers,
                 fmt::format("layers to save beside color, e.g. L0,L1, of: {}", fmt::join(kLayers, ", ")))
        ->delimiter(',')
        ->allow_extra_args(false);
    c.add_option("--stats", o.stats, "JSON file for statistics: settings, structures, losses, times");
    c.add_flag(
        "--resume", o.resume,
        "continue from the file of --state, which is left by interrupted and killed renders and by those that\n"
        "stopped early with --resume; with --frames: render the missing frames");
    c.add_option(
         "--checkpoint", o.checkpoint,
         "time after which the state of a picture is saved again, for --resume after a crash: 30s, 5min, or off\n"
         "(only when interrupted); longer where writing would take more than 2 % of the time")
        ->capture_default_str();
    c.add_option(
        "--state", o.state,
        "file of that state, 92 bytes a pixel; deleted when the picture is saved (default: F.exr.state beside\n"
        "--out, else F.png.state)");
    c.add_flag("--json", o.json, "print the statistics instead of text");
    c.add_flag("--quiet", o.quiet, "no progress bar");
    declare_frames(c, o);
    declare_rank_options(c, o.ranks);
    declare_method_options(c, o.settings);
    c.footer(R"(Examples:
  lightwell render atrium --size 160x100 --paths 16 --png atrium.png --out atrium.exr
  lightwell render atrium --camera courtyard --time 0.4 --size 96x64 --budget 500ms --out walk.exr --stats walk.json
  lightwell render cornell --look-from 0.278,0.273,-0.4 --look-at 0.278,0.2,0.3 --fov 60 --size 64x64 --out close.exr
  lightwell render cornell --until relmse=0.05 --size 48x48 --aovs L1,L2,variance --out cornell.exr
  lightwell render atrium --background transparent --size 64x48 --paths 4 --out cut.exr --png cut.png
  lightwell render atrium --size 64x64 --paths 4 --denoise atrous --out smooth.exr
  lightwell render atrium --size 64x64 --paths 64 --checkpoint 5min --state atrium.state --out long.exr
  lightwell render atrium --size 64x48 --paths 8 --aperture-radius 0.1 --focus-distance 3 --out lens.exr
  lightwell render atrium --camera courtyard --time 0.4 --shutter 0.04 --size 64x48 --paths 8 --out blur.exr
  lightwell render atrium --time 0.4 --eye left --screen-distance 6 --size 64x48 --paths 4 --out left.exr --png left.png
  lightwell render atrium --time 0.4 --eye right --screen-distance 6 --size 64x48 --paths 4 --out right.exr --png right.png
  lightwell render atrium --frames 0:3@10 --size 48x48 --paths 2 --out walk_%04d.exr --png walk_%04d.png
  lightwell render atrium --method paths --frames 0:3@24 --reuse 16 --paths 1 --bounces 2 --size 48x48 --out reuse_%04d.exr --stats reuse.json
  lightwell render cornell --frames 0:4@8 --turntable --size 48x48 --paths 2 --video turn.mkv

--stats and --json hold: schema, program, command, machine, settings, outputs, result (end, paths_per_pixel, seconds,
relmse_estimate, look_up_bias, rays, rays_per_s), plan (name, what, build, reason, numbers), report (stages_s, counts, losses,
peak_memory_bytes); for --frames, instead of result, one record per frame (frame, time_s, outputs, reused, seconds,
trace_s, paths_per_pixel, rays, relmse_estimate, end, losses) and frame_seconds (median, p95, p99, most, total).

Ctrl-C, SIGTERM and a closed terminal save the color of the picture so far, not denoised, and its state, and exit with
130, 143 and 129; a second Ctrl-C ends at once. With --resume, the same command then gives the picture of an
uninterrupted one, bit for bit, if --paths ends it; with --budget or --until, the number of paths depends on the time,
and a budget counts for each call.
(Except with --radiance-cache on, sh_grid and the methods of photons, whose light starts anew.)
With --frames, complete frames and the video so far are kept.)");
}

} // namespace viewer
