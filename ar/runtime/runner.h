#pragma once
// A session from its first frame to its last: frames in, composites out, everything timed and counted.
//
// Three threads, each a frame ahead of the next: one takes frames and finds the camera, one adds the virtual
// things, and the caller's shows. Between two of them one frame waits at most. At their own pace a newer frame
// takes the place of the one that waits, which counts as overtaken; as fast as possible, whoever is ahead waits,
// and what comes out is what one thread would have made, in every bit.

#include "ar/capture/frame_source.h"
#include "ar/pipeline/pipeline.h"
#include "ar/pose/pose_file.h"

#include <functional>
#include <memory>

namespace viewer {

struct ArRunOptions {
    int frames = 0; ///< at most; 0 = all
    ar::Pace pace = ar::Pace::own;
    std::vector<ar::TimedPose> poses; ///< where the camera was, in place of what frames say; empty = from markers
    /// A tracker, asked for each frame in place of all that; called by the thread that finds the camera.
    std::function<std::optional<ar::Pose>(ar::Frame const&)> tracked;
    bool find_poses_only = false; ///< nothing is rendered
    CompositeBy composite = CompositeBy::pipeline;
    /// Before the first frame, by the caller's thread.
    std::function<void(ar::SourceDescription const&, ArPipeline const&)> opened;
    /// Every frame as it came, those that are overtaken or refused later too. By the thread that takes them.
    std::function<void(ar::Frame const&)> taken;
    std::function<void()> idle; ///< by the caller's thread, every 10 ms while there is nothing to show
};

/// What one frame took, and what came of it. Of a frame that came at its own pace, age, times and show_wait follow
/// each other without gaps: age + times = latency; latency + show_wait + present = swapped.
struct ArFrameRecord {
    std::uint64_t sequence = 0;
    double captured_s = 0; ///< since the first frame
    /// On this machine's steady clock, where frames come at their own pace.
    std::optional<double> captured_steady_s;
    std::uint64_t overtaken = 0; ///< frames given up for newer ones, since the record before
    double read_ms = 0;          ///< of files read as fast as possible: until there was a frame
    double age_ms = 0;           ///< when it was handed over, since its capture
    double latency_ms = 0;       ///< when its composite was ready, since its capture
    double show_wait_ms = 0;     ///< then until it was shown
    double present_ms = 0;       ///< drawing and swap, where there is a window
    double swapped_ms = 0;       ///< when the swap was done, since its capture
    ar::Exposure exposure;
    ArTimes times;
    int markers = 0, points_used = 0, points_rejected = 0;
    double rms_px = 0, confidence = 0;
    std::optional<ar::Pose> world_from_camera;
    ar::CompositeCounts counts;
};

struct ArSummary {
    std::vector<ArFrameRecord> frames;
    ar::SourceCounts source;
    ar::SourceState end;
    std::uint64_t refused = 0;    ///< frames of another size, or that could not be decoded
    std::uint64_t overtaken = 0;  ///< given up, since a newer one was there
    std::uint64_t unfinished = 0; ///< that were on their way when it was ended
    double seconds = 0;
};

ArCamera load_ar_camera(std::filesystem::path const& calibration);

/// The source's delivered frames are those of the summary, refused, overtaken and unfinished ones. What is thrown
/// by any thread comes out here, after the results that were ready.
/// @param shown  called with every frame's result, if it is not empty; may ask for the end by `stop`
/// @param summary  kept up to date, so that it holds what there is when `shown` throws
void run_ar(ArSession const& session, ArRunOptions const& options,
            std::function<void(ArFrameRecord&, ArResult const&)> const& shown, gi::StopRequest const& stop,
            gi::Report& report, ArSummary& summary);
/// The same, of a source that is open, in place of the session's.
void run_ar(ArSession const& session, ar::FrameSource& source, ArRunOptions const& options,
            std::function<void(ArFrameRecord&, ArResult const&)> const& shown, gi::StopRequest const& stop,
            gi::Report& report, ArSummary& summary);

struct Spread {
    double median = 0, p95 = 0, most = 0;
};
/// Quantiles as gi/core/quantile.h defines them; zeros of nothing.
Spread spread_of(std::vector<double> values);

/// Median, 95 % and most of each stage, frames per second, latency, poses: lines of text.
std::string describe(ArSummary const& summary);

} // namespace viewer
