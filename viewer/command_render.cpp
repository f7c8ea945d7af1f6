#include "gi/base/error.h"
#include "gi/base/file.h"
#include "gi/base/picture_file.h"
#include "gi/registry/registry.h"
#include "viewer/commands.h"
#include "viewer/exposure.h"
#include "viewer/frame_options.h"
#include "viewer/frame_sequence.h"
#include "viewer/interrupt.h"
#include "viewer/load_world.h"
#include "viewer/outputs.h"
#include "viewer/render_picture.h"
#include "viewer/render_record.h"
#include "viewer/report_json.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

/// @param render  called with what stops it and shows how far it is
gi::RenderResult
trace(RenderOptions const& o,
      std::function<gi::RenderResult(gi::StopRequest const&, gi::RenderProgress const&)> const& render)
{
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    gi::ProgressBar bar("render " + std::filesystem::path(o.scene).filename().string(), !o.quiet);
    auto const show = [&](gi::RenderStatus const& s) {
        bar.update(s.fraction, fmt::format("{} paths, relMSE {:.2g}", s.paths, s.relmse));
    };
    return render(stop, show);
}

void save(RenderOptions const& o, gi::RenderSettings const& settings, gi::RenderResult& result, gi::Report& report)
{
    gi::StageTimer const timer(report, "save");
    gi::Picture& picture = result.picture;
    picture.metadata = make_metadata(o, settings, result);
    if (!o.png.empty()) gi::write_png(o.png, picture.width, picture.height, display_bytes(o, picture));
    keep_layers(o, picture);
    if (!o.out.empty()) save_exr(o, o.out, picture, report);
}

struct Shot {
    gi::ScenePlan plan;
    gi::RenderResult result;
};

Shot shoot_moment(RenderOptions const& o, gi::RenderSettings const& settings, gi::World const& world,
                  FrameCamera const& eye, gi::Report& report)
{
    gi::Camera const camera = eye.of(world, o.time_s.value_or(0), 0);
    gi::RenderResult result = trace(o, [&](gi::StopRequest const& stop, gi::RenderProgress const& progress) {
        return gi::find_method(o.method).render(world, camera, settings, stop, progress, report);
    });
    return {gi::plan_scene(world), std::move(result)};
}

/// While the shutter is open.
Shot shoot_motion(RenderOptions const& o, gi::RenderSettings const& settings, gi::MovingWorld& world,
                  FrameCamera const& eye, gi::Report& report)
{
    Exposure const exposure{*o.time_s, o.shutter_s, false, [&](gi::World const& now, double after_s) {
                                return eye.of(now, *o.time_s + after_s, 0);
                            }};
    gi::RenderResult result = trace(o, [&](gi::StopRequest const& stop, gi::RenderProgress const& progress) {
        return expose(gi::find_method(o.method), world, exposure, settings, stop, progress, report);
    });
    return {gi::plan_scene(world.world()), std::move(result)};
}

Shot shoot(RenderOptions const& o, gi::RenderSettings const& settings, CameraChoice const& choice,
           CameraMotion const& motion, gi::Report& report)
{
    auto const scene = load_lit_scene(o, report);
    bool const blurs = o.shutter_s > 0 && depends_on_time(*scene, false, motion);
    if (o.shutter_s > 0 && !blurs) say(kNothingMoves);
    gi::World still;
    std::optional<gi::MovingWorld> moving;
    {
        gi::StageTimer const timer(report, "world");
        if (blurs)
            moving.emplace(scene, *o.time_s, report);
        else
            still = gi::build_world(scene, o.time_s, report);
    }
    FrameCamera const eye(blurs ? moving->world() : still, choice, motion);
    if (!eye.note().empty()) say(eye.note());
    return blurs ? shoot_motion(o, settings, *moving, eye, report) : shoot_moment(o, settings, still, eye, report);
}

/// Options that no output reads.
void check_display(CLI::App const& command, RenderOptions const& o)
{
    for (char const* name : {"--exposure", "--tone"})
        if (command.get_option(name)->count() > 0 && o.png.empty() && o.video.empty())
            throw gi::InputError(std::string(name) + " without --png or --video",
                                 "it is about pictures for a display", "add --png F.png, or leave it out");
}

int run(RenderOptions o)
{
    gi::find_method(o.method);
    gi::RenderSettings const settings = make_settings(o);
    gi::DenoiseSettings const denoise_settings = make_denoise_settings(o, settings);
    CameraChoice const choice = camera_choice(o);
    if (!o.background.empty()) parse_background(o.background); // before any work
    if (!o.frames.empty()) return render_frames(o, settings, denoise_settings, choice);
    CameraMotion const motion = make_motion(o);
    check_outputs({o.out, o.png, o.stats, settings.checkpoint.string()}, {o.scene, o.environment, o.camera_path});
    std::string const state = o.out.empty() ? "" : o.out + ".state"; // also where this render keeps none
    bool const has_state = !state.empty() && std::filesystem::exists(state);
    if (o.resume && !has_state) say("there is no '" + state + "': starting afresh");
    if (!o.resume && has_state)
        throw gi::InputError("'" + state + "' holds an unfinished render", "a new one would replace it",
                             "add --resume to go on, or delete it");

    gi::Report report;
    auto [plan, result] = shoot(o, settings, choice, motion, report);
    std::string const remark = denoise(result.picture, denoise_settings, report);
    if (!remark.empty()) say(remark);
    save(o, settings, result, report);
    if (!settings.checkpoint.empty() && !result.resumable) std::filesystem::remove(settings.checkpoint);

    nlohmann::ordered_json const stats = make_stats(o, settings, plan, result, report);
    if (!o.stats.empty()) gi::write_text(o.stats, to_text(stats));
    if (o.json) {
        std::fputs(to_text(stats).c_str(), stdout);
    } else {
        for (std::string const& file : {o.out, o.png, o.stats})
            if (!file.empty()) fmt::print("{}\n", file);
        fmt::print("{}\n", summary_line(o, settings, result));
    }
    std::fflush(stdout);
    print_losses(report);
    if (result.end != gi::RenderEnd::interrupted) return 0;
    say(std::string("interrupted: the picture so far is saved") +
        (o.shutter_s > 0               ? "; with --shutter it cannot be resumed"
         : settings.checkpoint.empty() ? "; with --out it could be resumed"
                                       : "; the same command with --resume goes on"));
    return kInterrupted;
}

} // namespace

void add_render(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<RenderOptions>();
    CLI::App* const c = app.add_subcommand("render", "Render a scene to a picture with its error.");
    declare_options(*c, *o);
    c->callback([o, c, &exit_code] {
        check_slhb(*c, {{o->method, parse_schedule(o->schedule), "--schedule " + o->schedule}});
        check_display(*c, *o);
        exit_code = run(*o);
    });
}

} // namespace viewer
