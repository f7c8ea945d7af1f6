#pragma once
// Runs a session from its first frame to its last, with all stages timed and counted.
//
// Three threads, each a frame ahead of the next: one takes frames and estimates the camera pose, one adds the
// virtual objects, and the caller's shows the result. At most one frame waits between two threads. At the source's
// own pace a newer frame replaces the waiting one, which counts as overtaken; as fast as possible, the faster
// thread waits, and the composites are bit for bit those of a single thread.

#include "ar/capture/frame_source.h"
#include "ar/markers/seen_ids.h"
#include "ar/pipeline/pipeline.h"
#include "ar/pose/focal_check.h"
#include "ar/pose/pose_file.h"

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace ar {

struct RunOptions {
    int frames = 0; ///< at most; 0 = all
    Pace pace = Pace::own;
    std::vector<TimedPose> poses; ///< camera poses to use instead of markers; empty = from markers
    /// Callback to a tracker that replaces both; called for each frame by the pose-estimating thread.
    std::function<std::optional<gi::RigidPose>(Frame const&)> tracked;
    bool find_poses_only = false; ///< nothing is rendered
    bool keeps_depth = false;     ///< results have FrameResult::depth
    CompositeBy composite = CompositeBy::pipeline;
    /// Called before the first frame, by the caller's thread.
    std::function<void(SourceDescription const&, Pipeline const&)> opened;
    /// Called with every original frame, including those later overtaken or refused,
    /// by the thread that takes them.
    std::function<void(Frame const&)> taken;
    std::function<void()> idle; ///< called by the caller's thread every 10 ms while there is nothing to show
};

/// Times and results of one frame. For frames at their own pace the times are consecutive without gaps:
/// age + times = latency; latency + show_wait + present = swapped.
struct RunFrame {
    std::uint64_t sequence = 0;
    double captured_s = 0; ///< since the first frame
    /// The same on this machine's steady clock; none for files read as fast as possible.
    std::optional<double> captured_steady_s;
    std::uint64_t overtaken = 0; ///< frames discarded for newer ones since the previous record
    double read_ms = 0;          ///< reading time, for files read as fast as possible
    double age_ms = 0;           ///< from capture to delivery
    double latency_ms = 0;       ///< from capture to the finished composite
    double show_wait_ms = 0;     ///< from the finished composite until it was shown
    double present_ms = 0;       ///< drawing and swap, with a window
    double swapped_ms = 0;       ///< from capture to the end of the swap
    Exposure exposure;
    StageTimes times;
    int markers = 0, points_used = 0, points_rejected = 0;
    int markers_unknown = 0, markers_ambiguous = 0, boards_left_out = 0; ///< of the Sighting
    std::string lost_by; ///< why it has no trusted pose of its own; empty if it has one
    double rms_px = 0, confidence = 0;
    /// Of the pose that was used (ar/pose/expected_error.h). Of one held, faded or predicted: with its distance from
    /// the frame's own estimate, if it has one. Nothing: no pose, or one of a tracker or file.
    std::optional<double> expected_error_m;
    double distance_m = 0; ///< from the camera to the middle of the points; 0 = no estimate; held: of the last
    Visibility visibility = Visibility::unknown;
    double virtual_m = 0;                   ///< to the virtual objects, FrameResult::virtual_m
    std::optional<gi::RigidPose> estimated; ///< the frame's own pose, trusted or not
    PoseState state = PoseState::lost;
    double shown = 0;                          ///< share of the objects' change that is shown
    std::optional<gi::RigidPose> world_from_camera; ///< the pose that was used
    CompositeCounts counts;
};

struct RunSummary {
    std::string light; ///< how virtual objects were lit, and why
    std::vector<RunFrame> frames;
    SourceCounts source;
    SourceState end;
    std::uint64_t refused = 0;    ///< frames of another size, or that could not be decoded
    std::uint64_t overtaken = 0;  ///< discarded for a newer one
    std::uint64_t unfinished = 0; ///< in progress when the run was stopped
    double seconds = 0;
    CameraModel camera;
    MarkerMap markers;
    SeenIds ids;                                     ///< identifiers that the frames showed
    std::optional<OtherDictionary> other_dictionary; ///< of a frame in which none of the map's markers was seen
    std::optional<FocalFinding> focal;               ///< of a few frames with many points, found or not
};

/// @param report  if not null: as read_calibration
CalibratedCamera load_camera(std::filesystem::path const& calibration, gi::Report* report = nullptr);

/// The source's delivered frames are the sum of the summary's frames, refused, overtaken and unfinished ones.
/// Exceptions of any thread are rethrown here, after the results that were ready.
/// @param shown  if set, called with every frame's result; may end the run by `stop`
/// @param summary  kept up to date, so that it is valid if `shown` throws
void run_frames(Session const& session, RunOptions const& options,
                std::function<void(RunFrame&, FrameResult const&)> const& shown, gi::StopRequest const& stop,
                gi::Report& report, RunSummary& summary);
/// The same with an open source instead of the session's.
void run_frames(Session const& session, FrameSource& source, RunOptions const& options,
                std::function<void(RunFrame&, FrameResult const&)> const& shown, gi::StopRequest const& stop,
                gi::Report& report, RunSummary& summary);

struct Spread {
    double median = 0, p95 = 0, most = 0;
};
/// Quantiles as defined in gi/core/quantile.h; zeros for no values.
Spread spread_of(std::vector<double> values);

/// Number of frames with a trusted pose of their own.
std::size_t count_found(std::vector<RunFrame> const& frames);

/// The most frequent RunFrame::lost_by; empty = none.
std::string most_lost_by(std::vector<RunFrame> const& frames);

/// Lines of text: median, 95 % quantile and maximum of each stage, frames per second, latency, poses.
std::string describe(RunSummary const& summary);

/// CSV with a header line and one line per frame. Numbers missing between two lines are lost frames.
std::string frame_table(RunSummary const& summary);

/// How far the poses of a run could be trusted.
struct PoseTally {
    std::array<std::uint64_t, kPoseStates> states{}; ///< number of frames in each
    std::vector<double> confidence;                  ///< of the frames' own estimates

    void add(PoseState state, double confidence_, bool is_estimated)
    {
        ++states[std::size_t(state)];
        if (is_estimated) confidence.push_back(confidence_);
    }
    /// Frames with a trusted pose of their own.
    std::uint64_t found() const { return states[std::size_t(PoseState::tracked)]; }
};

/// A line of text: frames in each state, median and 5 % quantile of the confidence; empty without frames.
std::string describe(PoseTally const& tally);

} // namespace ar
