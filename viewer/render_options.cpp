#include "viewer/render_options.h"

#include "gi/base/error.h"
#include "gi/registry/registry.h"
#include "viewer/arguments.h"
#include "viewer/validators.h"

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

/// A picture that does not fit ends in swapping or in the kernel's killing the program, so it is refused before.
void check_memory(gi::RenderSettings const& s)
{
    constexpr double kBytesPerPixel = 300; // sums in double and all layers in float
    double const needed = kBytesPerPixel * s.width * s.height;
    double const there = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
    if (needed > there)
        throw gi::InputError(
            fmt::format("--size {}x{} is too large", s.width, s.height),
            fmt::format("it takes about {:.0f} GB of memory, of {:.0f}", needed * 1e-9, there * 1e-9),
            "choose a smaller one");
}

} // namespace

gi::RenderSettings make_settings(RenderOptions& o)
{
    if (int(o.paths.has_value()) + int(!o.budget.empty()) + int(!o.until.empty()) > 1)
        throw gi::InputError("--paths, --budget and --until are given together", "each says alone when to stop",
                             "keep one of them");
    for (std::string const& layer : o.layers)
        if (std::find(kLayers.begin(), kLayers.end(), layer) == kLayers.end())
            throw gi::InputError("there is no layer '" + layer + "'", "--aovs names layers of the picture",
                                 fmt::format("choose from: {}", fmt::join(kLayers, ", ")));
    if (o.out.empty() && o.png.empty()) o.out = std::filesystem::path(o.scene).stem().string() + ".exr";
    if (o.out.empty() && (o.resume || o.half || !o.layers.empty()))
        throw gi::InputError("--resume, --half and --aovs are about an EXR", "only --png is given",
                             "add --out F.exr");

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
    s.resume = o.resume;
    if (!o.out.empty()) s.checkpoint = o.out + ".state";
    return s;
}

void declare_view_options(CLI::App& c, RenderOptions& o)
{
    c.add_option("--camera", o.camera, "a camera of the scene (default: its first)");
    c.add_option("--look-from", o.look_from, "x,y,z, m");
    c.add_option("--look-at", o.look_at, "x,y,z, m (default: the middle of the scene)");
    c.add_option("--fov", o.fov_deg, "vertical field of view, degrees")->check(in_range(0.001, 179));
    c.add_option("--envmap", o.environment, "lat-long environment map, HDR or EXR");
    c.add_option("--envmap-rotate", o.environment_rotate_deg, "degrees about +Y, counter-clockwise from above")
        ->check(in_range(-1e6, 1e6));
    c.add_option("--envmap-scale", o.environment_scale, "factor on its radiance")->check(in_range(0, 1e9));
    c.add_option("--time", o.time_s, "moment of the animation, s")->check(in_range(-1e9, 1e9));
}

void declare_options(CLI::App& c, RenderOptions& o)
{
    c.add_option("SCENE", o.scene, "glTF, YAML, OBJ, PLY, FBX, ... file, or atrium, cornell")->required();
    std::string known;
    for (gi::Method const& m : gi::methods()) known += fmt::format("\n  {}: {}", m.name, m.summary);
    c.add_option("--method", o.method, "how light is computed:" + known)->capture_default_str();
    c.add_option("--size", o.size, "width x height, pixels")->capture_default_str();
    declare_view_options(c, o);
    c.add_option("--paths", o.paths, fmt::format("per pixel (default {})", kDefaultPaths))
        ->check(CLI::Range(1u, kNoLimit));
    c.add_option("--budget", o.budget, "time to trace: 500ms, 2s, 3min");
    c.add_option("--until", o.until, "relmse=E: until the estimated relative error is below");
    c.add_option("--bounces", o.bounces, "indirect bounces; 0 = direct light only")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    c.add_option("--filter", o.filter, "pixel filter")
        ->check(CLI::IsMember({"box", "tent"}))
        ->capture_default_str();
    c.add_option("--seed", o.seed, "another seed, another noise")
        ->check(refuse_negative)
        ->capture_default_str();
    c.add_option("--threads", o.threads, "0 = all")->check(CLI::Range(0, 4096))->capture_default_str();
    c.add_option("--out", o.out, "EXR with all layers (default: the scene's name)");
    c.add_flag("--half", o.half, "half floats where they suffice");
    CLI::Option* const png = c.add_option("--png", o.png, "tone-mapped picture");
    c.add_option("--exposure", o.exposure_ev, "stops, for --png")->check(in_range(-100, 100))->needs(png);
    c.add_option("--tone", o.tone, "curve, for --png")
        ->check(CLI::IsMember({"srgb", "filmic"}))
        ->capture_default_str()
        ->needs(png);
    c.add_option("--aovs", o.layers, fmt::format("layers to keep beside color, of: {}", fmt::join(kLayers, ", ")))
        ->delimiter(',')
        ->allow_extra_args(false);
    c.add_option("--stats", o.stats, "JSON file: what was asked, built, lost and measured");
    c.add_flag("--resume", o.resume, "go on from F.exr.state, which a render leaves that was interrupted, or stopped early with --resume");
    c.add_flag("--json", o.json, "print the statistics instead of text");
    c.add_flag("--quiet", o.quiet, "no progress bar");
    c.footer(R"(Examples:
  lightwell render atrium --size 160x100 --paths 16 --png atrium.png --out atrium.exr
  lightwell render atrium --camera courtyard --time 0.4 --size 96x64 --budget 500ms --out walk.exr --stats walk.json
  lightwell render cornell --look-from 0.278,0.273,-0.4 --look-at 0.278,0.2,0.3 --fov 60 --size 64x64 --out close.exr
  lightwell render cornell --until relmse=0.05 --size 48x48 --aovs L1,L2,variance --out cornell.exr

--stats and --json hold: schema, program, command, settings, outputs, result (end, paths_per_pixel, seconds,
relmse_estimate, rays, rays_per_s), plan (what, build, reason), report (stages_s, counts, losses,
peak_memory_bytes).

Ctrl-C saves the picture so far and F.exr.state, and exits with 130; a second one ends at once.)");
}

} // namespace viewer
