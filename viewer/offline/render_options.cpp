#include "viewer/offline/render_options.h"

#include "gi/core/error.h"
#include "gi/filter/filter_names.h"
#include "gi/kernel/device.h"
#include "gi/methods/registry.h"
#include "gi/methods/slhb/settings.h"
#include "gi/scene/model/camera.h"
#include "viewer/base/arguments.h"
#include "viewer/base/validators.h"
#include "viewer/engine/settings.h"
#include "viewer/offline/frame_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <unistd.h>

namespace viewer {
namespace {

constexpr std::array<std::string_view, 9> kLayers{"color",  "L0",    "L1",       "L2",      "albedo",
                                                  "normal", "depth", "position", "variance"};
constexpr std::uint32_t kDefaultPaths = 64, kNoLimit = 0x7fffffff;

/// Throws if the picture does not fit into memory; otherwise the machine would swap or kill the program.
void check_memory(gi::RenderSettings const& s)
{
    constexpr double kBytesPerPixel = 300; // sums in double and all layers in float
    double const needed = kBytesPerPixel * s.width * s.height;
    double const there = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
    if (needed > there)
        throw gi::InputError(
            fmt::format("--size {}x{} is too large", s.width, s.height),
            fmt::format("it needs about {:.0f} GB of memory, and there are {:.0f}", needed * 1e-9, there * 1e-9),
            "choose a smaller one");
}

void check_device(RenderOptions const& o, gi::SlhbSettings const& s)
{
    if (s.space == gi::Space::device && o.method != "slhb")
        throw gi::InputError("--device cuda with --method " + o.method, "it runs on the CPU only",
                             "add --method slhb, or leave --device out");
    gi::check_device(s.space);
}

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

/// File name from the name of the scene, which may be a folder with a trailing slash.
std::string default_out(std::string const& scene, char const* ending)
{
    std::filesystem::path const path = std::filesystem::absolute(scene).lexically_normal();
    return (path.has_filename() ? path : path.parent_path()).stem().string() + ending;
}

gi::LookUps parse_look_ups(std::string const& name)
{
    if (name == "all") return gi::LookUps::all;
    return name == "none" ? gi::LookUps::none : gi::LookUps::automatic;
}

gi::Shadows parse_shadows(std::string const& name)
{
    if (name == "maps") return gi::Shadows::maps;
    return name == "rays" ? gi::Shadows::rays : gi::Shadows::automatic;
}

gi::RadianceCaching parse_cache(std::string const& name)
{
    if (name == "on") return gi::RadianceCaching::on;
    return name == "off" ? gi::RadianceCaching::off : gi::RadianceCaching::automatic;
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
    if (o.out.empty() && (o.resume || o.half || !o.layers.empty()))
        throw gi::InputError("--resume, --half and --aovs need an EXR output", "none is saved",
                             is_sequence ? "add --out f_%04d.exr" : "add --out F.exr");

    gi::RenderSettings s;
    std::tie(s.width, s.height) = parse_size(o.size);
    check_memory(s);
    s.paths = o.budget.empty() && o.until.empty() ? o.paths.value_or(kDefaultPaths) : kNoLimit;
    if (!o.budget.empty()) s.budget_s = parse_duration("--budget", o.budget);
    if (!o.until.empty()) s.until_relmse = parse_target("--until", o.until, "relmse");
    s.bounces = o.bounces;
    s.seed = o.seed;
    s.threads = o.threads;
    s.filter = o.filter == "tent" ? gi::PixelFilter::tent : gi::PixelFilter::box;
    s.slhb = o.slhb;
    s.vpl = o.vpl;
    if (!o.points.empty()) s.vpl.points = parse_points("--points " + o.points, o.points, o.vpl.point_map);
    s.slhb.schedule = gi::parse_schedule(o.schedule);
    s.slhb.look_ups = parse_look_ups(o.look_ups);
    s.slhb.cache = parse_cache(o.radiance_cache);
    s.slhb.shadows = parse_shadows(o.shadows);
    s.slhb.space = o.device == "cuda" ? gi::Space::device : gi::Space::host;
    check_device(o, s.slhb);
    s.resume = o.resume && !is_sequence; // a sequence is resumed frame by frame
    if (o.shutter_s > 0) check_shutter(o, s);
    if (!o.out.empty() && !is_sequence && o.shutter_s == 0) s.checkpoint = o.out + ".state";
    return s;
}

gi::DenoiseSettings make_denoise_settings(RenderOptions const& o, gi::RenderSettings const& s)
{
    gi::DenoiseSettings d = gi::find_filter(o.denoise);
    gi::check_filter(d);
    d.threads = s.threads;
    if (d.denoiser != gi::Denoiser::none && !gi::can_filter(d, s.paths, o.reuse > 1))
        throw gi::InputError("--denoise atrous with --paths 1",
                             "it needs the variance, which one path does not give",
                             "trace two paths or more, add --reuse to frames, or choose --denoise discontinuity");
    return d;
}

void declare_view_options(CLI::App& c, RenderOptions& o)
{
    c.add_option("--camera", o.camera, "name of a camera of the scene (default: its first)");
    c.add_option("--look-from", o.look_from, "position of the camera, x,y,z, m");
    c.add_option("--look-at", o.look_at, "point to look at, x,y,z, m (default: middle of the scene)");
    c.add_option("--fov", o.fov_deg, "vertical field of view, degrees")->check(in_range(0.001, 179));
    c.add_option("--envmap", o.environment, "lat-long environment map, HDR or EXR");
    c.add_option("--envmap-rotate", o.environment_rotate_deg, "degrees about +Y, counter-clockwise from above")
        ->check(in_range(-1e6, 1e6));
    c.add_option("--envmap-scale", o.environment_scale, "scale factor of its radiance")->check(in_range(0, 1e9));
    c.add_option("--time", o.time_s, "animation time, s")->check(in_range(-1e9, 1e9));
}

void declare_lens_options(CLI::App& c, RenderOptions& o)
{
    c.add_option("--aperture-radius", o.aperture_radius_m,
                 "radius of a thin lens, m, for depth of field (default: the camera's, else 0, a pinhole)")
        ->check(in_range(0, gi::kWidestLens_m));
    c.add_option("--focus-distance", o.focus_distance_m,
                 "distance of the plane in focus along the view, m (default: the camera's, else that of\n"
                 "--look-at or the middle of the scene)")
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

constexpr char const* kSlhbGroup = "Method slhb";

void slhb_number(CLI::App& c, char const* name, int& value, int low, int high, char const* meaning)
{
    c.add_option(name, value, meaning)->check(CLI::Range(low, high))->group(kSlhbGroup);
}

void declare_slhb_quality(CLI::App& c, RenderOptions& o)
{
    gi::SlhbSettings& s = o.slhb;
    slhb_number(c, "--axes", s.axes, 1, 64, "axes per bounce in a pass; schedules streamed and temporal");
    slhb_number(c, "--fresh-axes", s.fresh_axes, 1, 64, "axes replaced per pass; schedule temporal");
    slhb_number(c, "--light-samples,--lamps", s.light_samples, 1, 64,
                "number of light samples given a shadow map per pass");
    slhb_number(c, "--fresh-light-samples,--fresh-lamps", s.fresh_light_samples, 1, 64,
                "light samples replaced per pass (default: all; few in consecutive frames)");
    slhb_number(c, "--shadow-map", s.shadow_resolution, 2, 8192, "size of a shadow map, texels on a side");
    slhb_number(c, "--interleave", s.interleave, 1, 16,
                "compute indirect light for one pixel in each n x n block per pass (default: by the budget)");
    slhb_number(c, "--memory", s.memory_mib, 1, 1 << 24,
                "MiB for hit buffers, and as much for shadow maps; they get fewer texels if it is not enough\n"
                "(default: a quarter of the machine's memory)");
    slhb_number(c, "--max-layers", s.most_layers, 0, 1 << 20, "most layers per texel, others counted; 0 = all");
    c.add_option(
         "--roulette", s.roulette,
         "Russian roulette: paths continue with a probability of this times their throughput; 0: all paths\n"
         "continue up to the fourth scattering (default: 2 with --until, --frames, or a --budget for more than\n"
         "one path; 3 if paths end in a cache; else 0)")
        ->check(in_range(0, 1000))
        ->group(kSlhbGroup);
    c.add_option("--cone", s.cone, "radius of the cone approximation, texels")
        ->check(in_range(0, 64))
        ->group(kSlhbGroup);
    c.add_flag("--packed", s.packed, "use layers of 32 bits instead of 64, for up to 524288 triangles")
        ->group(kSlhbGroup);
    c.add_flag("--gather", s.gather, "first bounce along all axes in turn instead of at random")
        ->group(kSlhbGroup);
}

namespace {

/// Reason why a method, with its schedule, does not use an option; null if it does.
char const* why_unread(NamedMethod const& method, std::string const& option)
{
    if (method.method == "vpl_slhb") {
        for (char const* const read : {"--directions", "--hit-buffer", "--max-layers"})
            if (option == read) return nullptr;
        return "it uses only the stored axes of --directions";
    }
    gi::Schedule const schedule = method.schedule;
    bool const directions = option == "--directions", axes = option == "--axes", fresh = option == "--fresh-axes";
    switch (schedule) {
    case gi::Schedule::stored:
        return axes ? "all axes of --directions are used" : fresh ? "its axes do not change" : nullptr;
    case gi::Schedule::streamed:
        if (fresh) return "all axes of a pass are new";
        [[fallthrough]];
    case gi::Schedule::temporal:
        return directions ? "axes are drawn from all directions" : nullptr;
    case gi::Schedule::automatic:
        break;
    }
    return nullptr;
}

} // namespace

void check_slhb(CLI::App const& command, std::vector<NamedMethod> const& methods)
{
    for (CLI::Option const* const option : command.get_options()) {
        if (option->get_group() != kSlhbGroup || option->count() == 0) continue;
        std::string const name = option->get_name();
        NamedMethod const* unread = nullptr; // by the first method that has options of slhb
        bool read = false;
        for (NamedMethod const& m : methods) {
            if (m.method != "slhb" && m.method != "vpl_slhb") continue;
            read |= why_unread(m, name) == nullptr;
            if (unread == nullptr) unread = &m;
        }
        if (unread == nullptr)
            throw gi::InputError(name + " with --method " + methods.front().method, "it applies to method slhb",
                                 "add method slhb, or leave it out");
        if (!read)
            throw gi::InputError(name + " with " +
                                     (unread->method == "slhb" ? unread->as_given : "--method " + unread->method),
                                 why_unread(*unread, name), "leave one of them out");
    }
    auto const given = [&](char const* name) { return command.get_option(name)->count() > 0; };
    bool const any_schedule = std::ranges::all_of(
        methods, [](NamedMethod const& m) { return m.method != "slhb" || m.schedule == gi::Schedule::automatic; });
    if (any_schedule && given("--directions") && (given("--axes") || given("--fresh-axes")))
        throw gi::InputError("--directions with --axes or --fresh-axes",
                             "only the stored schedule uses --directions, only the others draw axes",
                             "leave one of them out");
    for (auto const& [part, all] :
         {std::pair{"--fresh-axes", "--axes"}, std::pair{"--fresh-light-samples", "--light-samples"}})
        if (given(part) && given(all) && command.get_option(part)->as<int>() > command.get_option(all)->as<int>())
            throw gi::InputError(std::string(part) + " is larger than " + all, "it is the part that is new",
                                 fmt::format("give at most {}", command.get_option(all)->as<int>()));
}

void declare_slhb(CLI::App& c, RenderOptions& o)
{
    c.add_option("--device", o.device,
                 "cpu; or cuda: all by CUDA kernels, also with --reuse or --shutter; paths end at mirrors,\n"
                 "glass and narrow lobes, which is counted")
        ->check(CLI::IsMember({"cpu", "cuda"}))
        ->capture_default_str()
        ->group(kSlhbGroup);
    c.add_option(
         "--schedule", o.schedule,
         "stored: one set of axes; streamed: new axes in every pass; temporal: some new; auto: "
         "streamed,\nbut stored under a sky; in moving scenes stored with --reuse, streamed with --shutter")
        ->check(CLI::IsMember({"auto", "stored", "streamed", "temporal"}))
        ->capture_default_str()
        ->group(kSlhbGroup);
    c.add_option("--look-ups", o.look_ups,
                 "all: paths find surfaces by look-ups in hit buffers; none: by exact rays; auto: by the plan")
        ->check(CLI::IsMember({"auto", "all", "none"}))
        ->capture_default_str()
        ->group(kSlhbGroup);
    c.add_option(
         "--shadows", o.shadows,
         "maps: shadow maps of --light-samples samples, shared by all paths of a pass;\nrays: exact rays to "
         "light samples of each path; auto: by the plan")
        ->check(CLI::IsMember({"auto", "maps", "rays"}))
        ->capture_default_str()
        ->group(kSlhbGroup);
    c.add_option(
         "--radiance-cache", o.radiance_cache,
         "paths may end in cached cells of radiance from earlier paths: far less noise in the same time, but\n"
         "slightly blurred indirect light; auto: on with --budget, and in viewers while something moves")
        ->check(CLI::IsMember({"auto", "on", "off"}))
        ->capture_default_str()
        ->group(kSlhbGroup);
    c.add_option("--directions", o.slhb.directions, "stored directions, FAMILY:COUNT (default icosahedron:320)")
        ->group(kSlhbGroup);
    slhb_number(c, "--hit-buffer", o.slhb.resolution, 2, 8192,
                "size of a hit buffer, texels on a side (default: by the plan)");
    declare_slhb_quality(c, o);
}

void declare_options(CLI::App& c, RenderOptions& o)
{
    c.add_option(
         "SCENE", o.scene,
         "glTF, YAML, OBJ, PLY, FBX, ... file, a folder of OBJ or PLY frames, or atrium, cornell, mirror, avatar")
        ->required();
    std::string known;
    for (gi::Method const& m : gi::methods()) known += fmt::format("\n  {}: {}", m.name, m.summary);
    c.add_option("--method", o.method, "light transport method:" + known)->capture_default_str();
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
    c.add_option("--budget", o.budget, "time for structures and paths: 500ms, 2s, 3min");
    c.add_option("--until", o.until, "relmse=E: render until the estimated relMSE is below E");
    c.add_option("--bounces", o.bounces, "indirect bounces; 0 = direct light only")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    c.add_option("--filter", o.filter, "pixel filter")
        ->check(CLI::IsMember({"box", "tent"}))
        ->capture_default_str();
    declare_denoise(c, o);
    c.add_option("--seed", o.seed, "seed of the random numbers")->check(check_seed)->capture_default_str();
    c.add_option("--threads", o.threads, "threads; 0 = all")->check(CLI::Range(0, 4096))->capture_default_str();
    c.add_option("--out", o.out, "EXR file for all layers, .exr (default: the scene's name)");
    c.add_flag("--half", o.half, "16-bit floats for layers for which they suffice");
    c.add_option("--png", o.png, "PNG file for the tone-mapped picture, .png");
    c.add_option("--exposure", o.exposure_ev, "in stops, for --png and --video")->check(in_range(-100, 100));
    c.add_option("--tone", o.tone, "tone curve, for --png and --video")
        ->check(CLI::IsMember({"srgb", "filmic"}))
        ->capture_default_str();
    c.add_option("--aovs", o.layers, fmt::format("layers to save beside color, of: {}", fmt::join(kLayers, ", ")))
        ->delimiter(',')
        ->allow_extra_args(false);
    c.add_option("--stats", o.stats, "JSON file for statistics: settings, structures, losses, times");
    c.add_flag(
        "--resume", o.resume,
        "continue from F.exr.state, which is left by interrupted renders and by those that stopped early with\n"
        "--resume; with --frames: render the missing frames");
    c.add_flag("--json", o.json, "print the statistics instead of text");
    c.add_flag("--quiet", o.quiet, "no progress bar");
    declare_frames(c, o);
    declare_rank_options(c, o.ranks);
    declare_slhb(c, o);
    declare_virtual_lights(c, o);
    c.footer(R"(Examples:
  lightwell render atrium --size 160x100 --paths 16 --png atrium.png --out atrium.exr
  lightwell render atrium --camera courtyard --time 0.4 --size 96x64 --budget 500ms --out walk.exr --stats walk.json
  lightwell render cornell --look-from 0.278,0.273,-0.4 --look-at 0.278,0.2,0.3 --fov 60 --size 64x64 --out close.exr
  lightwell render cornell --until relmse=0.05 --size 48x48 --aovs L1,L2,variance --out cornell.exr
  lightwell render atrium --background transparent --size 64x48 --paths 4 --out cut.exr --png cut.png
  lightwell render atrium --size 64x64 --paths 4 --denoise atrous --out smooth.exr
  lightwell render atrium --size 64x48 --paths 8 --aperture-radius 0.1 --focus-distance 3 --out lens.exr
  lightwell render atrium --camera courtyard --time 0.4 --shutter 0.04 --size 64x48 --paths 8 --out blur.exr
  lightwell render atrium --time 0.4 --eye left --screen-distance 6 --size 64x48 --paths 4 --out left.exr --png left.png
  lightwell render atrium --time 0.4 --eye right --screen-distance 6 --size 64x48 --paths 4 --out right.exr --png right.png
  lightwell render atrium --frames 0:3@10 --size 48x48 --paths 2 --out walk_%04d.exr --png walk_%04d.png
  lightwell render atrium --method slhb --frames 0:3@24 --reuse 16 --paths 1 --bounces 2 --size 48x48 --out reuse_%04d.exr --stats reuse.json
  lightwell render cornell --frames 0:4@8 --turntable --size 48x48 --paths 2 --video turn.mkv

--stats and --json hold: schema, program, command, machine, settings, outputs, result (end, paths_per_pixel, seconds,
relmse_estimate, rays, rays_per_s), plan (what, build, reason), report (stages_s, counts, losses,
peak_memory_bytes); for --frames, instead of result, one record per frame (frame, time_s, outputs, reused, seconds,
trace_s, paths_per_pixel, rays, relmse_estimate, end, losses) and frame_seconds (median, p95, p99, most, total).

Ctrl-C saves the picture so far and F.exr.state, and exits with 130; a second one ends at once.
With --frames, complete frames and the video so far are kept.)");
}

} // namespace viewer
