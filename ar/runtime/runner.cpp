#include "ar/runtime/runner.h"

#include "ar/calibration/calibration_file.h"
#include "ar/capture/clock.h"
#include "ar/markers/marker_map_file.h"
#include "ar/runtime/frames_apart.h"
#include "ar/runtime/run_threads.h"
#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

RunFrame record_of(FrameInFlight const& w, bool is_timed)
{
    Frame const& frame = w.frame;
    FrameResult const& r = w.result;
    RunFrame f;
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
    f.markers_unknown = r.sighting.markers_unknown;
    f.markers_ambiguous = r.sighting.markers_ambiguous;
    f.boards_left_out = int(r.sighting.contradictions.size());
    f.lost_by = r.lost_by;
    f.points_used = r.pose.points_used;
    f.points_rejected = r.pose.points_rejected;
    f.rms_px = r.pose.rms_px;
    f.confidence = r.pose.confidence;
    f.distance_m = r.pose.found() ? r.pose.distance_m : 0;
    f.visibility = r.visibility;
    f.virtual_m = r.virtual_m;
    if (r.pose.found()) f.estimated = r.pose.world_from_camera;
    f.state = r.used.state;
    f.shown = r.used.shown;
    f.world_from_camera = r.used.world_from_camera;
    f.counts = r.counts;
    f.show_wait_ms = 1e3 * (steady_now_s() - r.done_s);
    return f;
}

/// @param before  the frame before; null = none
void add_expected_error(RunFrame& f, PoseEstimate const& own, RunFrame const* before)
{
    std::optional<double> const own_m = own.found() ? own.expected_error_m : std::nullopt;
    if (f.state == PoseState::tracked) {
        f.expected_error_m = own_m;
    } else if (f.world_from_camera) {
        if (before != nullptr) f.expected_error_m = before->expected_error_m;
        if (before != nullptr && f.distance_m == 0) f.distance_m = before->distance_m;
        if (own_m) {
            double const apart_m = glm::length(f.world_from_camera->position - own.world_from_camera.position);
            f.expected_error_m = std::max(f.expected_error_m.value_or(0), std::hypot(apart_m, *own_m));
        }
    }
}

/// Keeps what the doubts at the end need.
class Evidence {
public:
    /// @param picture  the camera's frame
    void add(Sighting const& s, cv::Mat const& picture, RunSummary& summary)
    {
        constexpr std::size_t kManyPoints = 8;
        for (auto const& [dictionary, ids] : s.ids) summary.ids[dictionary].insert(ids.begin(), ids.end());
        any_seen_ = any_seen_ || !s.ids.empty();
        // Markers of another dictionary are squares with an unknown code.
        if (!any_seen_ && s.candidates_rejected > most_rejected_) {
            most_rejected_ = s.candidates_rejected;
            unread_ = picture;
        }
        if (s.points.size() < kManyPoints) return;
        if (views_.wants_next())
            views_.add(s);
        else
            views_.skip();
    }
    void finish(RunSummary& summary)
    {
        summary.focal = contradicted_focal_length(summary.camera, views_.take());
        if (any_seen_ || unread_.empty()) return;
        cv::Mat gray;
        cv::cvtColor(eight_bits_of(unread_), gray, cv::COLOR_RGB2GRAY);
        summary.other_dictionary = other_dictionary(gray, summary.markers);
    }

private:
    SpacedFrames<Sighting> views_{12};
    bool any_seen_ = false;
    int most_rejected_ = 0;
    cv::Mat unread_;
};

} // namespace

CalibratedCamera load_camera(std::filesystem::path const& file, gi::Report* report)
{
    Calibration const c = read_calibration(file, std::nullopt, report);
    CalibratedCamera camera{c.camera, c.photometry ? *c.photometry : srgb_photometry(), {}};
    if (c.noise) {
        camera.noise.constant.fill(float(c.noise->read));
        camera.noise.per_unit.fill(float(c.noise->photon));
    }
    return camera;
}

void run_frames(Session const& session, RunOptions const& options,
                std::function<void(RunFrame&, FrameResult const&)> const& shown, gi::StopRequest const& stop,
                gi::Report& report, RunSummary& summary)
{
    OpenOptions open = session.frames.options;
    open.pace = options.pace;
    auto const source = open_source(session.frames.source, open);
    run_frames(session, *source, options, shown, stop, report, summary);
}

void run_frames(Session const& session, FrameSource& source, RunOptions const& options,
                std::function<void(RunFrame&, FrameResult const&)> const& shown, gi::StopRequest const& stop,
                gi::Report& report, RunSummary& summary)
{
    CalibratedCamera const camera = load_camera(session.camera, &report);
    MarkerMap const markers = read_marker_map(session.markers, &report);
    summary.camera = camera.model;
    summary.markers = markers;
    Evidence evidence;
    SourceDescription const about = source.description();
    check_size(about.size_px, camera);
    Pipeline pipeline(session, camera, markers, report, {}, options.find_poses_only);
    if (!options.find_poses_only) summary.light = pipeline.lit_by();
    if (options.keeps_depth) pipeline.keep_depth();
    if (options.opened) options.opened(about, pipeline);
    bool const is_timed = options.pace == Pace::own || about.is_live;
    double const begun_s = steady_now_s();
    RunThreads ahead(source, pipeline, options, is_timed, {session.frames.source, about, is_timed}, report);
    while (!stop.requested() && !ahead.has_ended() &&
           (options.frames == 0 || int(summary.frames.size()) < options.frames)) {
        std::optional<FrameInFlight> const w = ahead.next(std::chrono::milliseconds(10));
        ahead.tell(summary);
        summary.seconds = steady_now_s() - begun_s;
        if (w) {
            RunFrame record = record_of(*w, is_timed);
            add_expected_error(record, w->result.pose, summary.frames.empty() ? nullptr : &summary.frames.back());
            summary.frames.push_back(std::move(record));
            evidence.add(w->result.sighting, w->result.camera, summary);
            if (shown) shown(summary.frames.back(), w->result);
        } else if (options.idle) {
            options.idle();
        }
    }
    ahead.end();
    ahead.tell(summary);
    summary.seconds = steady_now_s() - begun_s;
    summary.unfinished = summary.source.delivered - summary.frames.size() - summary.refused - summary.overtaken;
    evidence.finish(summary);
    ahead.rethrow();
}

} // namespace ar
