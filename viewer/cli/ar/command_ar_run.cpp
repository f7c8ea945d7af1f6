#include "ar/runtime/frame_truth.h"
#include "ar/runtime/pose_rows.h"
#include "ar/runtime/run_doubts.h"
#include "ar/runtime/runner.h"
#include "ar/scene/read_values.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/camera_view/ar_window.h"
#include "viewer/camera_view/camera_tracker.h"
#include "viewer/camera_view/hmd_run.h"
#include "viewer/camera_view/session_inputs.h"
#include "viewer/cli/ar/ar_outcome.h"
#include "viewer/cli/ar/ar_recording.h"
#include "viewer/cli/ar/ar_truth_json.h"
#include "viewer/cli/ar/pose_arguments.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
    std::string session, out, video, record_input, truth, true_poses, frame_table, stats, display, require_found,
        confidence;
    PoseArguments poses;
    int frames = 0;
    bool fast = false, window = false, gpu = false;
    std::string monitor, eyes;
    bool hmd = false, seated = false;
    std::string passes;
    int pass_bits = 0; ///< 0 = as the session
    bool undistorted = false;
};

/// Throws if an input would be overwritten.
void check_arguments(RunArguments const& a, ar::Session const& session)
{
    std::vector<std::string> read{a.poses.file, a.true_poses};
    for (fs::path const& file : files_read_by(session)) read.push_back(file.string());
    check_outputs({a.frame_table, a.confidence, a.stats, a.video}, read);
    std::vector<fs::path> folders{folder_of_source(session.frames.source), a.truth};
    if (session.hmd && session.hmd->right) folders.push_back(folder_of_source(session.hmd->right->source));
    if (session.occlusion)
        for (auto const* pictures : {&session.occlusion->depth, &session.occlusion->matte})
            if (*pictures) folders.push_back(folder_of_source((*pictures)->source.string()));
    std::error_code ignored;
    for (fs::path const& folder : folders)
        if (!a.out.empty() && !folder.empty() && fs::equivalent(a.out, folder, ignored))
            throw gi::InputError("--out '" + a.out + "' is a folder that is read",
                                 "its pictures would be replaced", "name another folder");
    folders.emplace_back(a.out);
    fs::path const& passes = session.passes.folder;
    for (fs::path const& folder : folders)
        if (!passes.empty() && !folder.empty() && (passes == folder || fs::equivalent(passes, folder, ignored)))
            throw gi::InputError("the passes' folder '" + passes.string() + "' has other pictures in this run",
                                 "they would be mixed or replaced", "name another folder");
    if (!passes.empty() && a.hmd)
        throw gi::InputError("passes with --hmd", "they are written of one camera's run", "leave one out");
    if (!passes.empty() && a.gpu)
        throw gi::InputError("passes with --gpu", "their composite would not be the one shown", "leave one out");
    if (a.undistorted && passes.empty())
        throw gi::InputError("--undistorted without --passes", "it is how passes are written",
                             "add --passes FOLDER");
    if (a.pass_bits != 0 && passes.empty())
        throw gi::InputError("--pass-bits without --passes", "it is how passes are written",
                             "add --passes FOLDER");
    if (a.eyes.empty()) return;
    if (!fs::create_directories(a.eyes, ignored) && ignored)
        throw gi::InputError("'" + a.eyes + "' cannot be made", ignored.message(), "choose another folder");
    fs::path const eyes = a.eyes;
    check_outputs({(eyes / "left.png").string(), (eyes / "right.png").string(), a.stats}, read);
}

/// Reads the session and applies the tracker options of the command line.
ar::Session session_of(RunArguments const& a)
{
    ar::Session session = ar::read_session(a.session);
    if (!a.poses.file.empty())
        session.tracked.reset();
    else if (!a.display.empty()) {
        if (!session.tracked) session.tracked.emplace();
        session.tracked->display = a.display;
    }
    if (!a.passes.empty()) session.passes.folder = a.passes;
    if (a.pass_bits != 0) session.passes.bits = a.pass_bits;
    if (a.undistorted) session.passes.is_undistorted = true;
    return session;
}

int run_in_hmd(RunArguments const& a, ar::Session const& session, ar::RunOptions const& o,
               gi::StopRequest const& stop, std::optional<CameraTracker> const& tracker, gi::Report& report)
{
    ArHmdOptions hmd;
    hmd.pass_through = {o.frames, o.pace, o.poses, o.tracked};
    hmd.headset.space = a.seated ? HmdSpace::local : HmdSpace::stage;
    hmd.eyes = a.eyes;
    ArHmdSummary summary;
    auto const keep = [&] {
        if (!a.stats.empty()) gi::write_text(a.stats, to_text(to_json(report)));
        if (tracker) fmt::print("{}", tracker->describe());
        fmt::print("{}", describe(summary));
        print_losses(report);
    };
    try {
        run_ar_in_hmd(session, hmd, stop, report, summary);
    } catch (...) {
        if (summary.frames.frames > 0) keep();
        throw;
    }
    keep();
    if (summary.frames.end.kind == ar::SourceState::Kind::lost) {
        std::fputs(fmt::format("lightwell: the source was lost: {}\n", summary.frames.end.reason).c_str(), stderr);
        return 1;
    }
    if (summary.frames.frames == 0 && !stop.requested())
        throw gi::InputError("no frame could be used", describe(summary.frames.left),
                             "check the session's frames");
    if (stop.requested()) return interrupted_code();
    PassThroughCounts const& f = summary.frames;
    return exit_code_of(shortfall({f.frames, f.poses.found(), f.refused + f.left.refused},
                                  parse_share("--require-found", a.require_found)));
}

/// How a file's poses cover the frames of a source that ended by itself; empty without a file.
std::string rows_of(std::vector<ar::TimedPose> const& poses, std::string const& file,
                    ar::RunSummary const& summary, ar::Session const& session, gi::Report& report)
{
    bool const is_whole = summary.end.kind == ar::SourceState::Kind::ended;
    if (file.empty() || poses.empty() || summary.frames.empty() || !is_whole) return {};
    ar::PoseRows const rows = ar::compare_rows(poses, summary.frames);
    std::uint64_t const first = summary.frames.front().sequence;
    if (rows.after > 0 && first > 0 && !ar::is_device(session.frames.source) &&
        !session.frames.options.first_number)
        report.lose(
            "in doubt: which picture the first pose belongs to", 1,
            fmt::format("'{}' has poses after the last frame, and the first frame, number {}, is taken for "
                        "time 0; if the numbers begin with 0, write frames: {{first: 0}}",
                        file, first));
    return describe(rows, "poses of '" + file + "'");
}

int run_session(RunArguments const& a, bool poses_only)
{
    auto const required = parse_share("--require-found", a.require_found);
    check_rotation_order(a.poses.order, {a.poses.file, a.true_poses});
    ar::Session const session = session_of(a);
    check_arguments(a, session);
    if (!a.video.empty()) {
        glm::ivec2 const size_px = ar::load_camera(session.camera).model.size_px;
        check_video(a.video, size_px.x, size_px.y, 30);
    }
    ar::RunOptions o;
    o.frames = a.frames;
    o.pace = a.fast ? ar::Pace::fastest : ar::Pace::own;
    o.find_poses_only = poses_only;
    o.keeps_depth = !session.passes.folder.empty();
    if (a.gpu) o.composite = ar::CompositeBy::window;
    gi::Report report;
    o.poses = poses_of(a.poses, session, report);
    std::optional<CameraTracker> tracker;
    if (session.tracked) {
        tracker.emplace(*session.tracked, report);
        o.poses = tracker->recorded();
        if (tracker->is_live()) o.tracked = [&](ar::Frame const& f) { return tracker->at(f.captured_s); };
    }
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    if (a.hmd) return run_in_hmd(a, session, o, stop, tracker, report);
    std::vector<ar::TimedPose> const true_poses = true_poses_of(a.true_poses, a.poses.order, session, report);
    ar::FrameTruth truth(a.truth, true_poses);
    ArRecording recording({a.out, a.video, a.record_input, session.camera.string(),
                           a.fast ? ar::PictureThread::WhenFull::wait : ar::PictureThread::WhenFull::lose,
                           poses_only ? ar::PassSettings{} : session.passes});
    std::optional<ArWindow> window;
    std::optional<ar::Compositor> compositor;
    o.opened = [&](ar::SourceDescription const& source, ar::Pipeline const& pipeline) {
        if (a.gpu) compositor = pipeline.compositor();
        ArWindowSettings settings{.size_px = source.size_px, .monitor = a.monitor};
        settings.compositor = compositor ? &*compositor : nullptr;
        if (a.window) window.emplace(settings, report);
        recording.begin(source, pipeline.camera().model, pipeline.compositor(), report);
    };
    if (!a.record_input.empty()) o.taken = [&](ar::Frame const& f) { recording.add_input(f); };
    auto const look = [&] {
        if (window && window->wants_close()) stop.request();
    };
    o.idle = [&] {
        if (window) window->idle();
        look();
    };
    ar::RunSummary summary;
    auto const keep = [&](std::string const& recorded) {
        ar::report_counts(summary.source, report);
        std::string const rows = rows_of(o.poses, a.poses.file, summary, session, report) +
                                 rows_of(true_poses, a.true_poses, summary, session, report);
        ar::report_losses(truth.errors(), report);
        ar::report_doubts(summary, report);
        if (!a.stats.empty()) {
            nlohmann::ordered_json stats = to_json(report);
            if (truth.errors().has_pictures || truth.errors().has_poses) stats["truth"] = to_json(truth.errors());
            gi::write_text(a.stats, to_text(stats));
        }
        if (tracker) fmt::print("{}", tracker->describe());
        if (!a.frame_table.empty()) gi::write_text(a.frame_table, ar::frame_table(summary));
        if (!a.confidence.empty())
            gi::write_text(a.confidence, to_csv(ar::confidence_curve(truth.errors().poses.estimates())));
        fmt::print("{}{}{}{}", describe(summary), rows, describe(truth.errors()), recorded);
        print_losses(report);
    };
    auto const shown = [&](ar::RunFrame& f, ar::FrameResult const& r) {
        if (window) window->show(f, r);
        look();
        recording.add(f, r);
        truth.add(f, r);
    };
    try {
        ar::run_frames(session, o, shown, stop, report, summary);
        recording.finish();
    } catch (...) {
        try {
            recording.finish();
        } catch (std::exception const&) { // only the first error is reported
        }
        if (!summary.frames.empty()) keep(recording.text());
        throw;
    }
    keep(recording.text());
    if (summary.end.kind == ar::SourceState::Kind::lost) {
        std::fputs(fmt::format("lightwell: the source was lost: {}\n", summary.end.reason).c_str(), stderr);
        return 1;
    }
    if (!recording.failure().empty()) {
        std::fputs(fmt::format("lightwell: '{}' was cut off ({}) frames written before can be played\n",
                               a.record_input, recording.failure())
                       .c_str(),
                   stderr);
        return 1;
    }
    if (summary.frames.empty() && !stop.requested())
        throw gi::InputError("no frame could be used", describe(summary.source), "check the session's frames");
    bool const was_closed = window && window->wants_close();
    if (stop.requested()) return was_closed ? 0 : interrupted_code();
    return exit_code_of(shortfall({summary.frames.size(), ar::count_found(summary.frames),
                                   summary.refused + summary.source.refused, ar::most_lost_by(summary.frames),
                                   ar::hint_of(summary, true_poses)},
                                  required));
}

void add_session_options(CLI::App& c, RunArguments& a)
{
    c.add_option("session", a.session, "Session file: frame source, markers and virtual objects (docs/ar.md)")
        ->required();
    c.add_option("--frames", a.frames, "Process at most this many; 0 = all")->check(CLI::NonNegativeNumber);
    c.add_flag("--fast", a.fast, "Read files as fast as frames are processed, not at their own rate");
    c.add_option("--table", a.frame_table, "CSV file with one row per frame: times, pose, counts");
    c.add_option("--stats", a.stats, "JSON file: seconds of the renderer's stages, counts, losses");
    c.add_option("--display", a.display,
                 "Display file whose tracker gives the camera pose, instead of markers (docs/displays.md)");
    declare_require_found(c, a.require_found);
    CLI::Option* const truth =
        c.add_option("--true-poses", a.true_poses, "True camera poses, to report the pose error and its jumps");
    c.add_option("--confidence-table", a.confidence, "CSV file: error of the poses by their confidence")
        ->needs(truth);
}

} // namespace

void add_ar_run(CLI::App& ar, int& exit_code)
{
    auto const run = std::make_shared<RunArguments>();
    CLI::App* const run_command = ar.add_subcommand("run", "Add virtual objects to frames, live or from files");
    add_session_options(*run_command, *run);
    run_command->add_option("-o,--out", run->out, "Folder for the composites, as PNG");
    CLI::Option* const passes = run_command->add_option(
        "--passes", run->passes, "Folder for the parts of each composite, as multi-layer EXR (docs/ar.md)");
    run_command->add_option("--pass-bits", run->pass_bits, "Bits of the passes' radiance, 16 (default) or 32")
        ->check(CLI::IsMember({16, 32}));
    run_command->add_flag("--undistorted", run->undistorted, "Passes as of a pinhole, not in the camera's lens");
    run_command->add_option("--video", run->video,
                            "Video of the composites, .mkv (lossless) or .mp4; each is shown until the next");
    run_command
        ->add_option("--record-input", run->record_input, "Folder to create: the camera's frames as a session")
        ->excludes("--fast");
    declare_poses(*run_command, run->poses);
    CLI::Option* const window =
        run_command->add_flag("--window", run->window, "Show a window: S before/after, H panel, Escape ends");
    run_command->add_option("--monitor", run->monitor, "Full screen on the monitor with this number or name")
        ->needs("--window");
    CLI::Option* const hmd = run_command->add_flag(
        "--hmd", run->hmd, "Show in the OpenXR headset that carries the camera (docs/hmd.md)");
    run_command->add_flag("--seated", run->seated, "With --hmd: space without a floor")->needs(hmd);
    run_command->add_option("--eyes", run->eyes, "With --hmd: folder for the last pictures of both eyes, as PNG")
        ->needs(hmd);
    run_command->add_option("--truth", run->truth,
                            "Folder of reference pictures, with the virtual objects as real ones, to report FLIP");
    hmd->excludes(passes);
    for (char const* other : {"--window", "--out", "--video", "--record-input", "--table", "--truth",
                              "--true-poses", "--confidence-table"})
        hmd->excludes(run_command->get_option(other));
    run_command
        ->add_flag("--gpu", run->gpu, "Composite on the window's GPU: at most 1 different per byte, no counts")
        ->needs(window)
        ->excludes("--out")
        ->excludes("--video")
        ->excludes("--truth");
    run_command->footer(R"(Prepared by:
  lightwell ar synthesize desk --frames 2 --size 160x120 --paths 4
Examples:
  lightwell ar run desk/session.yaml --fast --poses desk/poses.csv --table frames.csv --stats stages.json
  lightwell ar run desk/session.yaml --poses desk/poses.csv --video desk.mkv --record-input desk/recorded
  lightwell ar run desk/session.yaml --fast --poses desk/poses.csv --passes desk/passes --pass-bits 32

A frame is dropped and counted as overtaken if a newer one arrives before it is rendered; never with --fast.
Exit code 1: no frame has a trusted pose, most frames were refused, or fewer have one than --require-found.)");
    run_command->callback([run, &exit_code] { exit_code = run_session(*run, false); });
}

void add_ar_track(CLI::App& ar, int& exit_code)
{
    auto const track = std::make_shared<RunArguments>();
    CLI::App* const track_command =
        ar.add_subcommand("track", "Find the camera pose in each frame, with its confidence");
    add_session_options(*track_command, *track);
    declare_rotation_order(*track_command, track->poses.order);
    track_command->footer(R"(Prepared by:
  lightwell ar synthesize tracked --frames 2 --size 640x480 --paths 2 --no-truth
Examples:
  lightwell ar track tracked/session.yaml --fast --true-poses tracked/poses.csv --require-found 90%

Exit code 1: no frame has a trusted pose, most frames were refused, or fewer have one than --require-found.)");
    track_command->callback([track, &exit_code] { exit_code = run_session(*track, true); });
}

} // namespace viewer
