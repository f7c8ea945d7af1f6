#include "ar/light/lamps.h"
#include "ar/pipeline/frame_light.h"
#include "ar/runtime/runner.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/camera_view/session_inputs.h"
#include "viewer/cli/ar/ar_outcome.h"
#include "viewer/cli/ar/ar_posed_frames.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct LightArguments {
    std::string session, out, stats;
    PosedFrameChoice read{{}, 1, 0, -1};
    bool json = false;
    ar::FrameLightSettings settings;
};

ordered_json numbers(cv::Vec3d const& v) { return {v[0], v[1], v[2]}; }
ordered_json numbers(glm::dvec3 const& v) { return {v.x, v.y, v.z}; }

ordered_json json_of_light(ar::FrameLight const& light)
{
    ordered_json j;
    j["scale_is_known"] = light.scale_is_known;
    for (ar::FrameLight::Face const& f : light.faces)
        j["faces"].push_back(
            {{"normal", numbers(f.normal)}, {"irradiance", numbers(f.irradiance)}, {"relative_sigma", f.sigma}});
    j["lights"] = ordered_json::array();
    for (ar::FittedLamp const& l : light.fit.lamps)
        j["lights"].push_back({{"direction", numbers(l.direction)},
                               {"half_angle_deg", glm::degrees(l.half_angle_rad)},
                               {"irradiance", numbers(l.irradiance)},
                               {"sigma", numbers(l.sigma)},
                               {"explained_share", l.gain}});
    if (auto const d = ar::dominant_lamp(light.fit))
        j["dominant"] = {{"direction", numbers(d->direction)}, {"irradiance", numbers(d->irradiance)}};
    j["albedos"] = ordered_json::object();
    for (auto const& a : light.albedos)
        j["albedos"][a.name] = {{"albedo", numbers(a.albedo)}, {"pixels", a.samples}};
    ar::FrameLightCounts const& n = light.counts;
    j["pixels"] = {{"used", n.used},
                   {"clipped", n.clipped},
                   {"dark", n.dark},
                   {"border", n.border},
                   {"not_matt", n.not_matt},
                   {"background", n.background},
                   {"background_clipped", n.background_clipped},
                   {"outliers", light.fit.outliers}};
    j["unexplained"] = light.fit.residual;
    j["unexplained_without_lights"] = light.fit.residual_without_lamps;
    j["undetermined_share"] = light.undetermined_share;
    j["undetermined_share_above"] = light.undetermined_above;
    j["seen_share"] = light.seen_share;
    j["warnings"] = ar::warnings_of(light);
    return j;
}

void check_light_outputs(LightArguments const& a, ar::Session session)
{
    session.light.clear(); // may be what is written
    session.real.estimates.clear();
    if (!a.read.poses.file.empty()) session.tracked.reset();
    std::vector<std::string> read{a.read.poses.file};
    for (fs::path const& file : files_read_by(session)) read.push_back(file.string());
    check_outputs({a.out, a.stats}, read);
    check_ending(a.out, ".exr", "an OpenEXR map", "write --out light.exr");
}

int run_light(LightArguments& a)
{
    if (a.read.only >= 0) a.read.views = 1;
    ar::Session const session = ar::read_session(a.session);
    check_light_outputs(a, session);
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    ar::CalibratedCamera const camera = ar::load_camera(session.camera, &report);
    ar::RealScene real = model_of(session.real, report);
    PosedFrames const seen = read_posed_frames(a.read, session, camera, stop, report);
    if (stop.requested()) return interrupted_code();
    if (seen.kept.empty() && a.read.only >= 0)
        throw gi::InputError(fmt::format("--frame {}", a.read.only),
                             "it does not exist or has no trusted camera pose",
                             "check with lightwell ar track --table");
    ar::FrameLight const light =
        ar::estimate_light(std::move(real), camera.model, camera.photometry, seen.kept, a.settings, stop, report);
    if (stop.requested()) return interrupted_code();
    ar::write_light(a.out, light, report);
    ordered_json j = json_of_light(light);
    j["frames"] = {{"compared", seen.kept.size()},
                   {"found", seen.found},
                   {"without_pose", seen.without_pose},
                   {"refused", seen.refused}};
    if (!a.stats.empty()) {
        ordered_json all = j;
        all["report"] = to_json(report);
        gi::write_text(a.stats, to_text(all));
    }
    if (a.json)
        fmt::print("{}", to_text(j));
    else {
        fmt::print("camera found in {} frames ({} without, {} unusable); {} compared\n{}", seen.found,
                   seen.without_pose, seen.refused, seen.kept.size(), describe(light));
        for (std::string const& w : ar::warnings_of(light)) fmt::print("not to be trusted: {}\n", w);
        fmt::print("{}: {} x {}\n", a.out, light.map.cols, light.map.rows);
    }
    print_losses(report);
    return exit_code_of(
        most_refused(std::uint64_t(seen.found + seen.without_pose), std::uint64_t(seen.refused), "frames"));
}

} // namespace

void add_ar_light(CLI::App& ar, int& exit_code)
{
    auto const a = std::make_shared<LightArguments>();
    CLI::App* const c = ar.add_subcommand(
        "light", "Estimate the light of the place without a probe, from the shading of a session's real surfaces");
    c->add_option("session", a->session, "with real surfaces (real:) and, of some of them, their albedos")
        ->required();
    c->add_option("-o,--out", a->out, "Map to write, .exr; set it as the session's light: {map: FILE}")->required();
    declare_poses(*c, a->read.poses);
    CLI::Option* const views =
        c->add_option("--views", a->read.views, "Number of frames to compare, spread over the session")
            ->check(CLI::Range(1, 100))
            ->capture_default_str();
    c->add_option("--frame", a->read.only, "Number of the only frame to compare")
        ->check(CLI::NonNegativeNumber)
        ->excludes(views);
    c->add_option("--frames", a->read.frames, "Read at most this many frames; 0 = all (files only)")
        ->check(CLI::NonNegativeNumber);
    c->add_option("--samples", a->settings.samples, "Pixels compared, over all frames")
        ->check(CLI::Range(200, 50000))
        ->capture_default_str();
    c->add_option("--lights", a->settings.fit.most_lamps, "Most lamps, the sun included, to find")
        ->check(CLI::Range(0, 8))
        ->capture_default_str();
    c->add_option("--mean-albedo", a->settings.mean_albedo, "Mean albedo of the surfaces if none is known")
        ->check(CLI::Range(0.05, 0.9))
        ->capture_default_str();
    c->add_flag("--json", a->json, "Print the result as JSON");
    c->add_option("--stats", a->stats, "File for the result, times and losses, as JSON");
    c->footer(R"(Prepared by:
  lightwell ar synthesize desk --frames 2 --size 160x120 --paths 4
Examples:
  lightwell ar light desk/session.yaml --poses desk/poses.csv --views 2 --out light.exr

Reported are the irradiance of six faces with its standard deviation, lamps, and what the frames do not determine.
Exit code 1: most frames were refused.)");
    c->callback([a, &exit_code] { exit_code = run_light(*a); });
}

} // namespace viewer
