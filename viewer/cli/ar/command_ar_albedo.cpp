#include "ar/markers/marker_map_file.h"
#include "ar/pipeline/estimate_albedo.h"
#include "ar/pose/pose_file.h"
#include "ar/runtime/runner.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"
#include "viewer/base/arguments.h"
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

struct AlbedoArguments {
    std::string session, out;
    PosedFrameChoice read;
    bool scene = false;
    ar::EstimateSettings settings;
};

void write_texture(fs::path const& file, cv::Mat const& linear)
{
    cv::Mat const srgb = ar::bytes_of(linear, ar::srgb_photometry());
    gi::write_png(file, srgb.cols, srgb.rows, {srgb.ptr(), srgb.total() * 3});
}

std::string describe(ar::AlbedoEstimate const& e, PosedFrames const& seen)
{
    ar::AlbedoFit const& fit = e.solution.fit;
    std::string text = fmt::format("camera found in {} frames ({} without, {} unusable); {} compared\n",
                                   seen.found, seen.without_pose, seen.refused, seen.kept.size());
    text += fmt::format("{:<28} {:^23} {:^23} {:>8}\n", "", "albedo", "spread of pixels", "pixels");
    for (ar::AlbedoEntry const& p : e.entries)
        text += p.samples == 0 ? fmt::format("{:<28} not seen\n", p.name)
                               : fmt::format("{:<28} {:7.4f} {:7.4f} {:7.4f} {:7.4f} {:7.4f} {:7.4f} {:>8}\n",
                                             p.name, p.albedo.x, p.albedo.y, p.albedo.z, p.spread.x, p.spread.y,
                                             p.spread.z, p.samples);
    text +=
        fmt::format("left out: {} clipped pixels, {} in the dark, {} at borders, {} highlights, {} not finite; {} "
                    "values clamped\n",
                    fit.clipped, fit.dark, fit.border, fit.specular, fit.not_finite, fit.clamped);
    if (e.texels > 0)
        text += fmt::format("textures: {} texels, {} not seen (set to the surface's median), {} pixels outside\n",
                            e.texels, e.filled, e.outside);
    text += fmt::format("{} iterations, last change {:.4f}{}\n", e.solution.iterations, e.solution.last_change,
                        e.solution.converged ? "" : " (not converged)");
    return text;
}

fs::path texture_beside(fs::path const& out, std::size_t patch)
{
    return out.parent_path() / fmt::format("{}-{}.png", out.stem().string(), patch + 1);
}

/// Throws if an input would be overwritten; earlier estimates may be.
void check_albedo_outputs(AlbedoArguments const& a, ar::Session session, fs::path const& out,
                          ar::RealScene const& real)
{
    session.real.estimates.clear();
    if (!a.read.poses.file.empty()) session.tracked.reset();
    std::vector<std::string> read{a.read.poses.file}, written{out.string()};
    for (fs::path const& file : files_read_by(session)) read.push_back(file.string());
    for (std::size_t k = 0; k < real.patches.size(); ++k)
        if (real.patches[k].texels > 0) written.push_back(texture_beside(out, k).string());
    check_outputs(written, read);
}

int run_albedo(AlbedoArguments const& a)
{
    ar::Session session = ar::read_session(a.session);
    if (a.scene) {
        if (session.real.scene.empty())
            throw gi::InputError("--scene with '" + a.session + "'", "the session has no real.scene",
                                 "write albedo: estimate at its planes, boxes, meshes or depth");
        session.real.estimate_scene = true;
    }
    if (session.light_from_frame)
        throw gi::InputError("'light: {from: frame}' in '" + a.session + "'",
                             "albedos are estimated from frames and known light",
                             "run lightwell ar light first, which estimates both, and set its map");
    fs::path const out = a.out.empty() ? session.real.estimates : fs::path(a.out);
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    ar::CalibratedCamera const camera = ar::load_camera(session.camera, &report);
    ar::RealScene real = model_of(session.real, report);
    check_albedo_outputs(a, session, out, real);
    PosedFrames const seen = read_posed_frames(a.read, session, camera, stop, report);
    if (stop.requested()) return interrupted_code();
    ar::AlbedoEstimate estimate = ar::estimate_albedos(std::move(real), ar::PlaceLight(session, report).begin(),
                                                       camera, seen.kept, a.settings, stop, report);
    if (stop.requested()) return interrupted_code(); // too few paths to keep
    for (std::size_t k = 0; k < estimate.entries.size(); ++k) {
        if (estimate.textures[k].empty()) continue;
        estimate.entries[k].texture = texture_beside(out, k);
        write_texture(estimate.entries[k].texture, estimate.textures[k]);
    }
    gi::write_text(out, ar::format_albedos(estimate.entries));
    fmt::print("{}{}\n", describe(estimate, seen), out.string());
    print_losses(report);
    return exit_code_of(
        most_refused(std::uint64_t(seen.found + seen.without_pose), std::uint64_t(seen.refused), "frames"));
}

} // namespace

void add_ar_albedo(CLI::App& ar, int& exit_code)
{
    auto const a = std::make_shared<AlbedoArguments>();
    CLI::App* const c = ar.add_subcommand(
        "albedo", "Estimate the albedo of a session's real objects from its frames and the captured light");
    c->add_option("session", a->session,
                  "with 'albedo: estimate' or 'texture: estimate' on the objects to estimate")
        ->required();
    c->add_option("-o,--out", a->out, "File for the albedos (default: the one that the session reads)");
    declare_poses(*c, a->read.poses);
    c->add_flag("--scene", a->scene, "Also estimate the scene's materials, if the session does not request it");
    c->add_option("--views", a->read.views, "Number of frames to compare, spread over the session")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    c->add_option("--frames", a->read.frames, "Read at most this many frames; 0 = all (files only)")
        ->check(CLI::NonNegativeNumber);
    c->add_option("--resolution", a->settings.resolution, "Pixels compared per pixel of the camera")
        ->check(CLI::Range(0.05, 1.0))
        ->capture_default_str();
    c->add_option("--paths", a->settings.paths, "Paths of the reference renderer per compared pixel")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    c->footer(R"(Prepared by:
  lightwell ar synthesize desk --frames 2 --size 160x120 --paths 4
Examples:
  lightwell ar albedo desk/session.yaml --scene --poses desk/poses.csv --views 2 --paths 4

Exit code 1: most frames were refused.)");
    c->callback([a, &exit_code] { exit_code = run_albedo(*a); });
}

} // namespace viewer
