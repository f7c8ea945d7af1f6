#include "viewer/ar/runner.h"

#include "ar/base/error.h"
#include "ar/calibration/calibration_file.h"
#include "ar/markers/marker_map_file.h"
#include "gi/base/error.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

namespace viewer {
namespace {

using Clock = std::chrono::steady_clock;

double now_s() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

ArFrameRecord record_of(ar::Frame const& frame, ArResult const& r, double time_s, bool is_live)
{
    ArFrameRecord f;
    f.sequence = frame.sequence;
    f.captured_s = time_s;
    f.exposure = frame.exposure;
    if (is_live) {
        f.captured_steady_s = frame.captured_s;
        f.age_ms = 1e3 * (frame.arrived_s - frame.captured_s);
        f.latency_ms = 1e3 * (now_s() - frame.captured_s);
    }
    f.times = r.times;
    f.markers = r.sighting.markers_seen;
    f.points_used = r.pose.points_used;
    f.points_rejected = r.pose.points_rejected;
    f.rms_px = r.pose.rms_px;
    f.confidence = r.pose.confidence;
    if (r.pose.found()) f.world_from_camera = r.pose.world_from_camera;
    f.counts = r.counts;
    return f;
}

bool is_recording(std::string const& source)
{
    return std::filesystem::exists(std::filesystem::path(source) / "session.json");
}

/// Clocks round: a frame may be a microsecond before the first pose or after the last.
std::optional<ar::Pose> told_pose(std::vector<ar::TimedPose> const& poses, double time_s)
{
    constexpr double rounding_s = 2e-6;
    double const first_s = poses.front().time_s, last_s = poses.back().time_s;
    if (time_s < first_s - rounding_s || time_s > last_s + rounding_s) return std::nullopt;
    return ar::pose_at(poses, std::clamp(time_s, first_s, last_s));
}

void check_size(glm::ivec2 frames_px, glm::ivec2 calibrated_px)
{
    if (frames_px == calibrated_px) return;
    throw gi::InputError(fmt::format("frames of {} x {} pixels", frames_px.x, frames_px.y),
                         fmt::format("the calibration is of {} x {}", calibrated_px.x, calibrated_px.y),
                         "set the camera to that size, or calibrate it at this one");
}

} // namespace

Spread spread_of(std::vector<double> values)
{
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    auto const at = [&](double share) { return values[std::size_t(share * double(values.size() - 1) + 0.5)]; };
    return {at(0.5), at(0.95), values.back()};
}

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
    ArCamera const camera = load_ar_camera(session.camera);
    ar::MarkerMap const markers = ar::read_marker_map(session.markers);
    ar::OpenOptions open = session.frames.options;
    open.pace = options.pace;
    auto const source = ar::open_source(session.frames.source, open);
    ar::SourceDescription const about = source->description();
    check_size(about.size_px, camera.model.size_px);
    ArPipeline pipeline(session, camera, markers, report);
    double const begun_s = now_s();
    bool const is_timed = options.pace == ar::Pace::own || about.is_live;
    // As fast as possible, clocks say nothing of the time that passes in pictures; recordings keep theirs.
    bool const is_numbered = !is_timed && about.frames_per_s > 0 && !is_recording(session.frames.source);
    std::optional<double> first_s;
    std::uint64_t first = 0;
    while (!stop.requested() && (options.frames == 0 || int(summary.frames.size()) < options.frames)) {
        std::optional<ar::Frame> const frame = source->next(std::chrono::milliseconds(200));
        summary.source = source->counts();
        summary.end = source->state();
        summary.seconds = now_s() - begun_s;
        if (!frame) {
            if (summary.end.kind != ar::SourceState::Kind::running) break;
            if (options.idle) options.idle();
            continue;
        }
        if (!first_s) {
            first_s = frame->captured_s;
            first = frame->sequence;
        }
        double const time_s =
            is_numbered ? double(frame->sequence - first) / about.frames_per_s : frame->captured_s - *first_s;
        std::optional<ar::Pose> known;
        bool const is_told = !options.poses.empty();
        if (is_told) known = told_pose(options.poses, time_s);
        try {
            ArResult r;
            if (is_told && !known)
                r.rgb = r.camera = ar::rgb_of(*frame); // the file does not say
            else if (options.find_poses_only)
                r = pipeline.find_pose(*frame, time_s);
            else
                r = pipeline.process(*frame, time_s, known, stop);
            summary.frames.push_back(record_of(*frame, r, time_s, is_timed));
            if (shown) shown(summary.frames.back(), r);
        } catch (ar::InputError const& e) {
            ++summary.refused;
            report.lose("frames that could not be used", 1, e.what());
        }
    }
    summary.seconds = now_s() - begun_s;
}

std::string describe(ArSummary const& s)
{
    std::size_t const n = s.frames.size();
    std::size_t const found = std::size_t(
        std::count_if(s.frames.begin(), s.frames.end(), [](auto const& f) { return bool(f.world_from_camera); }));
    std::string text =
        fmt::format("{} frames in {:.2f} s: {:.1f} frames/s; camera found in {} ({:.1f} %)\n", n, s.seconds,
                    n / std::max(s.seconds, 1e-9), found, n > 0 ? 100.0 * double(found) / double(n) : 0);
    text += fmt::format("source: {}{}\n", describe(s.source),
                        s.end.kind == ar::SourceState::Kind::lost ? "; lost: " + s.end.reason : "");
    if (s.refused > 0) text += fmt::format("refused: {} frames\n", s.refused);
    text += fmt::format("{:<24} {:>9} {:>9} {:>9}\n", "", "median", "95 %", "most");
    auto const line = [&](char const* name, auto const& value) {
        std::vector<double> values;
        for (ArFrameRecord const& f : s.frames) values.push_back(value(f));
        Spread const d = spread_of(std::move(values));
        if (d.most > 0) text += fmt::format("{:<24} {:>9.2f} {:>9.2f} {:>9.2f}\n", name, d.median, d.p95, d.most);
    };
    line("frame's age (ms)", [](auto const& f) { return f.age_ms; });
    line("decode (ms)", [](auto const& f) { return f.times.decode_ms; });
    line("detect (ms)", [](auto const& f) { return f.times.detect_ms; });
    line("pose (ms)", [](auto const& f) { return f.times.pose_ms; });
    line("light (ms)", [](auto const& f) { return f.times.light_ms; });
    line("render (ms)", [](auto const& f) { return f.times.render_ms; });
    line("composite (ms)", [](auto const& f) { return f.times.composite_ms; });
    line("capture to result (ms)", [](auto const& f) { return f.latency_ms; });
    line("present (ms)", [](auto const& f) { return f.present_ms; });
    line("capture to swap (ms)", [](auto const& f) { return f.swapped_ms; });
    line("reprojection RMS (px)", [](auto const& f) { return f.rms_px; });
    return text;
}

} // namespace viewer
