#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/methods/registry.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/base/standard_streams.h"
#include "viewer/base/version.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"
#include "viewer/offline/empty_view.h"
#include "viewer/offline/exposure.h"
#include "viewer/offline/finish_picture.h"
#include "viewer/offline/frame_options.h"
#include "viewer/offline/frame_sequence.h"
#include "viewer/offline/hidden_sky.h"
#include "viewer/offline/load_world.h"
#include "viewer/offline/picture_memory.h"
#include "viewer/offline/rank_work.h"
#include "viewer/offline/render_picture.h"
#include "viewer/offline/render_record.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <optional>
#include <utility>

namespace viewer {
namespace {

/// @param guard   holds from now on
/// @param render  called with the stop request and a progress callback
gi::RenderResult
trace(RenderOptions const& o, RankWork& work, std::unique_ptr<InterruptGuard>& guard,
      std::function<gi::RenderResult(gi::StopRequest const&, gi::RenderProgress const&)> const& render)
{
    guard = std::make_unique<InterruptGuard>(work.stop());
    gi::ProgressBar bar("render " + std::filesystem::path(o.scene).filename().string(), !o.quiet && work.leads());
    auto const show = [&](gi::RenderStatus const& s) {
        bar.update(s.fraction, fmt::format("{} paths, relMSE {:.2g}", s.paths, s.relmse));
    };
    return render(work.stop(), show);
}

struct Shot {
    gi::ScenePlan plan;
    gi::RenderResult result;
    std::map<std::string, gi::Report::Loss> loaded; ///< losses before path tracing
    std::unique_ptr<InterruptGuard> guard;
};

/// Of nearly all pixels of some rows.
bool is_black(gi::RenderResult const& result)
{
    constexpr double kNearlyAll = 0.98;
    constexpr float kDark = 1e-3f; // beside a sky's radiance of about 1
    constexpr int kRows = 16;
    gi::PictureRows const& rows = result.color_rows.read ? result.color_rows : result.rows;
    if (!rows.read || rows.height < 1) return false;
    std::size_t black = 0, all = 0;
    for (int k = 0; k < kRows; ++k) {
        gi::Picture const row = rows.read((2 * k + 1) * rows.height / (2 * kRows), 1);
        gi::Layer const* const color = row.find("color");
        if (color == nullptr) return false;
        all += color->data.size();
        black += std::size_t(std::ranges::count_if(color->data, [&](float v) { return !(v > kDark); }));
    }
    return double(black) >= kNearlyAll * double(all);
}

Shot shoot_moment(RenderOptions const& o, gi::RenderSettings const& settings, gi::World const& world,
                  FrameCamera const& eye, RankWork& work, gi::Report& report)
{
    gi::Camera const camera = eye.of(world, o.time_s.value_or(0), 0);
    report_empty_view(world, camera, settings.width, settings.height, report);
    auto const loaded = report.losses();
    std::unique_ptr<InterruptGuard> guard;
    gi::RenderResult result =
        trace(o, work, guard, [&](gi::StopRequest const& stop, gi::RenderProgress const& progress) {
            return gi::find_method(o.method).render(world, camera, settings, stop, progress, report);
        });
    if (world.environment && result.end != gi::RenderEnd::interrupted && is_black(result)) {
        std::vector<std::string> const meshes =
            meshes_before_sky(world, gi::camera_rays(camera, 1, 1, world.origin).origin, settings.threads);
        if (!meshes.empty())
            say(fmt::format(
                "the sky lights nothing: seen from the camera, nearly all of it lies behind '{}'. Give that an "
                "emission, put lamps inside, or take it out of the model",
                fmt::join(meshes, "', '")));
    }
    return {gi::plan_scene(world), std::move(result), loaded, std::move(guard)};
}

/// Renders with motion blur, over the time that the shutter is open.
Shot shoot_motion(RenderOptions const& o, gi::RenderSettings const& settings, gi::MovingWorld& world,
                  FrameCamera const& eye, RankWork& work, gi::Report& report)
{
    Exposure const exposure{*o.time_s, o.shutter_s, false, [&](gi::World const& now, double after_s) {
                                return eye.of(now, *o.time_s + after_s, 0);
                            }};
    gi::RenderSettings whole = settings;
    whole.by_rows = false;
    std::unique_ptr<InterruptGuard> guard;
    gi::RenderResult result =
        trace(o, work, guard, [&](gi::StopRequest const& stop, gi::RenderProgress const& progress) {
            return expose(gi::find_method(o.method), world, exposure, whole, stop, progress, report);
        });
    return {gi::plan_scene(world.world()), std::move(result), {}, std::move(guard)};
}

std::vector<std::string> outputs_of(RenderOptions const& o, gi::RenderSettings const& settings)
{
    return {o.out, o.png, o.stats, settings.checkpoint.string()};
}

Shot shoot(RenderOptions const& o, gi::RenderSettings const& settings, CameraChoice const& choice,
           CameraMotion const& motion, RankWork& work, gi::Report& report)
{
    auto const scene = load_lit_scene(o, report);
    check_outputs(outputs_of(o, settings), scene->files);
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
    return blurs ? shoot_motion(o, settings, *moving, eye, work, report)
                 : shoot_moment(o, settings, still, eye, work, report);
}

/// Throws if tone mapping options are given without an output that uses them.
void check_display(CLI::App const& command, RenderOptions const& o)
{
    for (char const* name : {"--exposure", "--tone"})
        if (command.get_option(name)->count() > 0 && o.png.empty() && o.video.empty())
            throw gi::InputError(std::string(name) + " without --png or --video",
                                 "it applies only to tone-mapped pictures", "add --png F.png, or leave it out");
}

void check_endings(RenderOptions const& o)
{
    check_ending(o.out, ".exr", "an OpenEXR picture", "use --png for a PNG, or end it with .exr");
    check_ending(o.png, ".png", "a PNG", "use --out for an OpenEXR picture, or end it with .png");
}

/// Throws on options that do not work with several processes.
void check_ranks(RenderOptions const& o, gi::RenderSettings const& s)
{
    auto const refuse = [](std::string const& option, std::string const& why, std::string const& suggestion) {
        return gi::InputError(option + " with several processes", why, suggestion);
    };
    if (o.frames.empty()) {
        if (s.budget_s > 0 || s.until_relmse > 0)
            throw refuse(s.budget_s > 0 ? "--budget" : "--until",
                         "the paths of each process must be known in advance", "give --paths");
        if (o.resume) throw refuse("--resume", "they save no state of a single picture", "leave it out");
        if (o.shutter_s > 0) throw refuse("--shutter", "one world moves through the exposure", "leave it out");
        return;
    }
    if (o.reuse > 1)
        throw refuse("--reuse", "a frame reuses light of earlier frames, which other processes render",
                     "render with one process, or leave --reuse out");
    if (!o.video.empty() && o.out.empty())
        throw refuse("--video", "the video is made from the frame files of all processes",
                     "add --out F_%04d.exr on a disk that all of them share");
}

/// What to say of a picture that was not written: its paths may be kept.
void say_what_is_kept(gi::RenderSettings const& settings, StillEnd const& end, gi::Report const& report)
{
    std::filesystem::path const& file = settings.checkpoint;
    if (file.empty()) return;
    if (end.result.resumable)
        return say("all paths are kept in '" + file.string() +
                   "': the same command with --resume makes the picture of them");
    print_losses(report);
    if (std::filesystem::exists(file))
        say("'" + file.string() + "' has earlier paths: --resume continues with them");
}

int render_still(RenderOptions const& o, gi::RenderSettings settings, gi::DenoiseSettings const& filter,
                 CameraChoice const& choice, RankWork& work)
{
    CameraMotion const motion = make_motion(o);
    check_outputs(outputs_of(o, settings), {o.scene, o.environment, o.camera_path});
    check_picture_memory(settings.width, settings.height);
    if (work.leads() && !check_state(settings, "add --resume"))
        say("there is no '" + settings.checkpoint.string() + "': starting afresh");
    settings.before_checkpoint = [&, state = settings.checkpoint.string()](std::uint64_t bytes) {
        std::string const again = settings.checkpoint_s > 0 && !work.stop().requested()
                                      ? fmt::format(" and again about every {:g} s", settings.checkpoint_s)
                                      : "";
        say(fmt::format("the state of the render is saved in '{}' ({}){}; --resume continues from it", state,
                        text_of_bytes(bytes), again));
    };
    if (!work.alone()) {
        settings.checkpoint.clear();
        settings.share = work.share(settings.paths);
    }

    gi::Report report;
    gi::ScenePlan plan;
    std::unique_ptr<InterruptGuard> guard;
    StillPicture picture{settings, filter};
    picture.trace = [&](gi::RenderSettings const& s, gi::StopRequest const&, gi::Report&) {
        Shot shot = shoot(o, s, choice, motion, work, report);
        work.gather(shot.result, report, shot.loaded);
        plan = std::move(shot.plan);
        guard = std::move(shot.guard);
        return std::move(shot.result);
    };
    if (work.leads())
        picture.write = [&](gi::PictureRows rows, PictureParts parts, gi::RenderResult const& result) {
            bool const is_complete = parts == PictureParts::complete;
            RenderOptions with = o;
            if (!is_complete) with.denoise = "none";
            rows.metadata = make_metadata(with, settings, result);
            if (parts == PictureParts::color_so_far) with.layers = {"color"};
            write_files(with, rows, is_complete ? &work.stop() : nullptr, report);
        };
    picture.interrupted = [](PictureParts parts) {
        say(std::string("interrupted: saving ") +
            (parts == PictureParts::color_so_far ? "the state and the color of " : "") + "the picture so far");
    };
    StillEnd const end = render_picture(std::move(picture), work.stop(), report);
    if (!work.leads()) {
        work.finish();
        return 0;
    }
    if (!end.note.empty()) say(end.note);
    if (end.failure) {
        say_what_is_kept(settings, end, report);
        std::rethrow_exception(end.failure);
    }
    gi::RenderResult const& result = end.result;
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
    work.finish();
    if (result.end != gi::RenderEnd::interrupted) return 0;
    say(std::string(result.resumable ? "interrupted: the color of the picture so far is saved"
                                     : "interrupted: the picture so far is saved") +
        (filter.denoiser != gi::Denoiser::none ? ", not denoised" : "") +
        (o.shutter_s > 0               ? "; with --shutter it cannot be resumed"
         : settings.checkpoint.empty() ? "; it cannot be resumed"
         : !result.resumable           ? "; its state could not be written, so it cannot be resumed"
                                       : "; the same command with --resume continues"));
    return interrupted_code();
}

int render_sequence(RenderOptions const& o, gi::RenderSettings const& settings, gi::DenoiseSettings const& filter,
                    CameraChoice const& choice, RankWork& work)
{
    InterruptGuard const guard(work.stop()); // before the video starts, so that its hidden file is removed
    gi::Report report;
    FramesEnd const end = render_frames(o, settings, filter, choice, work, report);
    if (work.leads()) {
        if (!o.stats.empty()) gi::write_text(o.stats, to_text(end.stats));
        if (o.json)
            std::fputs(to_text(end.stats).c_str(), stdout);
        else
            for (std::string const& line : end.lines) fmt::print("{}\n", line);
        std::fflush(stdout);
        print_losses(report);
    }
    for (std::string const& note : end.notes) say(note);
    work.finish();
    return !work.leads() || end.complete ? 0 : work.stop().requested() ? interrupted_code() : 1;
}

int run(RenderOptions o)
{
    gi::find_method(o.method);
    gi::RenderSettings const settings = make_settings(o);
    gi::DenoiseSettings const denoise_settings = make_denoise_settings(o, settings);
    check_endings(o);
    CameraChoice const choice = camera_choice(o);
    if (!o.background.empty()) parse_background(o.background); // before any work
    if (Cluster::started_by_mpirun()) check_ranks(o, settings);
    std::string const command = describe_call(o, settings, stop_option(settings), {}).at("command");
    Cluster cluster({version_text(), command, Cluster::started_by_mpirun() ? file_hash(o.scene) : 0},
                    cluster_settings(o.ranks));
    if (!cluster.leads()) be_silent();
    std::string const what_stays = o.frames.empty() ? "nothing is kept of a picture that several processes share"
                                   : o.out.empty()  ? "complete frames are kept"
                                                    : "the same command with --resume renders the missing frames";
    try {
        gi::StopRequest stop;
        RankWork work(cluster, stop);
        return o.frames.empty() ? render_still(o, settings, denoise_settings, choice, work)
                                : render_sequence(o, settings, denoise_settings, choice, work);
    } catch (RankInterrupted const&) {
        say("interrupted: " + what_stays);
        return interrupted_code();
    } catch (RankLoss const& e) {
        std::fputs(fmt::format("lightwell: {} stops: {}; {}\n", cluster.name(), e.what(), what_stays).c_str(),
                   stderr);
        return 1;
    } catch (std::exception const& e) {
        cluster.leave(e.what());
        throw;
    }
}

} // namespace

void add_render(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<RenderOptions>();
    CLI::App* const c = app.add_subcommand("render", about("render"));
    declare_options(*c, *o);
    c->callback([o, c, &exit_code] {
        check_method_options(*c, {{o->method, o->settings}});
        check_display(*c, *o);
        exit_code = run(*o);
    });
}

} // namespace viewer
