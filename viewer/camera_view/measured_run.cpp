#include "viewer/camera_view/measured_run.h"

#include "ar/capture/clock.h"
#include "ar/capture/frame_source.h"
#include "ar/runtime/frame_clock.h"
#include "ar/runtime/loop_source.h"
#include "ar/runtime/run_doubts.h"
#include "ar/scene/camera_poses.h"

namespace viewer {
namespace {

/// Returns the records without the first.
std::vector<ar::RunFrame> settled(std::vector<ar::RunFrame> frames)
{
    if (!frames.empty()) frames.erase(frames.begin());
    return frames;
}

ar::OpenOptions files_at_once(ar::Session const& session)
{
    ar::OpenOptions open = session.frames.options;
    open.pace = ar::Pace::fastest;
    return open;
}

/// Seconds since the first, as the run that takes them as fast as possible has them.
std::vector<double> times_of(std::vector<ar::Frame> const& frames, ar::FrameClock clock)
{
    std::vector<double> times_s;
    for (ar::Frame const& f : frames) times_s.push_back(clock(f));
    return times_s;
}

} // namespace

MeasuredRun measure_run(ar::Session const& session, MeasureSettings const& settings, gi::StopRequest& stop,
                        gi::Report& report)
{
    MeasuredRun m;
    ar::RunOptions o;
    o.pace = ar::Pace::fastest;
    o.frames = settings.frames;
    if (session.tracked) o.poses = recorded_poses(*session.tracked, report);
    std::vector<ar::TimedPose> true_poses;
    if (!settings.true_poses.empty())
        true_poses =
            ar::read_camera_poses(settings.true_poses, {ar::frames_per_s_of(session.frames)}, report).poses;
    ar::FrameTruth truth(settings.truth, std::move(true_poses));
    o.opened = [&](ar::SourceDescription const&, ar::Pipeline const& p) {
        m.compositor = p.compositor();
        m.is_prefiltered = p.is_prefiltered();
    };
    std::vector<ar::FrameResult> results; // evaluated afterwards, since that takes longer than a frame
    std::vector<double> shown_s;
    ar::RunSummary fast;
    std::optional<ar::Frame> first_frame; ///< with a pose
    gi::RigidPose first_pose;
    double first_s = 0;
    ar::run_frames(
        session, o,
        [&](ar::RunFrame& f, ar::FrameResult const& r) {
            shown_s.push_back(ar::steady_now_s());
            if (r.pair && r.used.world_from_camera && !first_frame) {
                first_frame.emplace();
                first_frame->sequence = f.sequence;
                first_frame->exposure = f.exposure;
                first_frame->size_px = {r.camera.cols, r.camera.rows};
                first_frame->planes[0] = r.camera;
                first_pose = *r.used.world_from_camera;
                first_s = f.captured_s;
            }
            if (r.pair || !m.last.pair) m.last = r;
            results.emplace_back();
            results.back().rgb = r.rgb;
            results.back().camera = r.camera;
        },
        stop, report, fast);
    ar::report_losses(fast.source, fast.end, report);
    if (shown_s.size() > 1) m.frames_per_s = double(shown_s.size() - 1) / (shown_s.back() - shown_s.front());
    for (std::size_t k = 0; k < results.size() && !stop.requested(); ++k) truth.add(fast.frames[k], results[k]);
    m.errors = truth.errors();
    ar::report_losses(m.errors, report);
    ar::report_doubts(fast, report);
    if (settings.still_frames > 1 && first_frame)
        m.flicker =
            ar::measure_flicker(session, *first_frame, first_pose, first_s, settings.still_frames, stop, report);
    m.refused = fast.refused + fast.source.refused;
    m.fast = settled(std::move(fast.frames));
    if (stop.requested()) return m;

    o.pace = ar::Pace::own;
    std::optional<ArWindow> window;
    o.opened = [&](ar::SourceDescription const& source, ar::Pipeline const&) {
        if (settings.in_window) window.emplace(ArWindowSettings{.size_px = source.size_px}, report);
    };
    o.idle = [&] {
        if (window) window->idle();
        if (window && window->wants_close()) stop.request();
    };
    o.frames = settings.frames + 1;
    std::unique_ptr<ar::FrameSource> camera = ar::open_source(session.frames.source, files_at_once(session));
    if (!camera->description().is_live) {
        double const own_hz = camera->description().frames_per_s;
        std::vector<ar::Frame> frames = ar::read_frames(*camera, settings.frames);
        ar::report_losses({}, camera->state(), report); // refused frames are already counted
        if (frames.empty()) return m;
        std::vector<double> times_s = times_of(frames, {session.frames.source, camera->description(), false});
        auto loop = std::make_unique<ar::LoopSource>(std::move(frames),
                                                     own_hz > 0 ? own_hz : session.frames.options.frames_per_s);
        if (!o.poses.empty()) // they come back with their frames
            o.tracked = [poses = o.poses, times_s = std::move(times_s), l = loop.get()](ar::Frame const& f) {
                return ar::recorded_pose(poses, times_s[l->index_of(f.sequence)]);
            };
        camera = std::move(loop);
    }
    ar::RunSummary own;
    ar::run_frames(
        session, *camera, o,
        [&](ar::RunFrame& f, ar::FrameResult const& r) {
            if (window) window->show(f, r);
        },
        stop, report, own);
    ar::report_losses(own.source, own.end, report);
    m.overtaken = own.overtaken;
    m.own = settled(std::move(own.frames));
    return m;
}

} // namespace viewer
