#include "ar/runtime/runner.h"

#include "ar/calibration/calibration_file.h"
#include "ar/capture/clock.h"
#include "ar/markers/marker_map_file.h"
#include "ar/runtime/run_threads.h"
#include "gi/core/error.h"

#include <fmt/format.h>

namespace viewer {
namespace {

ArFrameRecord record_of(FrameInFlight const& w, bool is_timed)
{
    ar::Frame const& frame = w.frame;
    ArResult const& r = w.result;
    ArFrameRecord f;
    f.sequence = frame.sequence;
    f.captured_s = w.time_s;
    f.exposure = frame.exposure;
    f.overtaken = w.overtaken;
    if (is_timed) {
        f.captured_steady_s = frame.captured_s;
        f.age_ms = 1e3 * (frame.arrived_s - frame.captured_s);
        f.latency_ms = 1e3 * (r.done_s - frame.captured_s);
    } else {
        f.read_ms = w.read_ms;
    }
    f.times = r.times;
    f.markers = r.sighting.markers_seen;
    f.points_used = r.pose.points_used;
    f.points_rejected = r.pose.points_rejected;
    f.rms_px = r.pose.rms_px;
    f.confidence = r.pose.confidence;
    if (r.pose.found()) f.estimated = r.pose.world_from_camera;
    f.state = r.used.state;
    f.shown = r.used.shown;
    f.world_from_camera = r.used.world_from_camera;
    f.counts = r.counts;
    f.show_wait_ms = 1e3 * (ar::steady_now_s() - r.done_s);
    return f;
}

} // namespace

ArCamera load_ar_camera(std::filesystem::path const& file)
{
    ar::Calibration const c = ar::read_calibration(file);
    ArCamera camera{c.camera, c.photometry ? *c.photometry : ar::srgb_photometry(), {}};
    if (c.noise) {
        camera.noise.constant.fill(float(c.noise->read));
        camera.noise.per_unit.fill(float(c.noise->photon));
    }
    return camera;
}

void run_ar(ArSession const& session, ArRunOptions const& options,
            std::function<void(ArFrameRecord&, ArResult const&)> const& shown, gi::StopRequest const& stop,
            gi::Report& report, ArSummary& summary)
{
    ar::OpenOptions open = session.frames.options;
    open.pace = options.pace;
    auto const source = ar::open_source(session.frames.source, open);
    run_ar(session, *source, options, shown, stop, report, summary);
}

void run_ar(ArSession const& session, ar::FrameSource& source, ArRunOptions const& options,
            std::function<void(ArFrameRecord&, ArResult const&)> const& shown, gi::StopRequest const& stop,
            gi::Report& report, ArSummary& summary)
{
    ArCamera const camera = load_ar_camera(session.camera);
    ar::MarkerMap const markers = ar::read_marker_map(session.markers);
    ar::SourceDescription const about = source.description();
    check_size(about.size_px, camera);
    ArPipeline pipeline(session, camera, markers, report);
    if (!options.find_poses_only) summary.light = pipeline.lit_by();
    if (options.keeps_depth) pipeline.keep_depth();
    if (options.opened) options.opened(about, pipeline);
    bool const is_timed = options.pace == ar::Pace::own || about.is_live;
    double const begun_s = ar::steady_now_s();
    RunThreads ahead(source, pipeline, options, is_timed, {session.frames.source, about, is_timed}, report);
    while (!stop.requested() && !ahead.has_ended() &&
           (options.frames == 0 || int(summary.frames.size()) < options.frames)) {
        std::optional<FrameInFlight> const w = ahead.next(std::chrono::milliseconds(10));
        ahead.tell(summary);
        summary.seconds = ar::steady_now_s() - begun_s;
        if (w) {
            summary.frames.push_back(record_of(*w, is_timed));
            if (shown) shown(summary.frames.back(), w->result);
        } else if (options.idle) {
            options.idle();
        }
    }
    ahead.end();
    ahead.tell(summary);
    summary.seconds = ar::steady_now_s() - begun_s;
    summary.unfinished = summary.source.delivered - summary.frames.size() - summary.refused - summary.overtaken;
    ahead.rethrow();
}

} // namespace viewer
