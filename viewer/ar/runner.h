#pragma once
// A session from its first frame to its last: frames in, composites out, everything timed and counted.

#include "ar/capture/frame_source.h"
#include "ar/pose/pose_file.h"
#include "viewer/ar/pipeline.h"

#include <functional>
#include <memory>

namespace viewer {

struct ArRunOptions {
    int frames = 0; ///< at most; 0 = all
    ar::Pace pace = ar::Pace::own;
    std::vector<ar::TimedPose> poses; ///< where the camera was, in place of what frames say; empty = from markers
    bool find_poses_only = false;     ///< nothing is rendered
    std::function<void()> idle;       ///< while no frame comes
};

/// What one frame took, and what came of it.
struct ArFrameRecord {
    std::uint64_t sequence = 0;
    double captured_s = 0; ///< since the first frame
    double age_ms = 0;     ///< when it was handed over, since its capture
    std::optional<double>
        captured_steady_s; ///< on this machine's steady clock, where frames come at their own pace
    double latency_ms = 0; ///< when its composite was ready, since its capture
    double present_ms = 0; ///< drawing and swap, where there is a window
    double swapped_ms = 0; ///< when the swap was done, since its capture
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
    std::uint64_t refused = 0; ///< frames of another size, or that could not be decoded
    double seconds = 0;
};

ArCamera load_ar_camera(std::filesystem::path const& calibration);

/// @param shown  called with every frame's result, if it is not empty; may ask for the end by `stop`
/// @param summary  kept up to date, so that it holds what there is when `shown` throws
void run_ar(ArSession const& session, ArRunOptions const& options,
            std::function<void(ArFrameRecord&, ArResult const&)> const& shown, gi::StopRequest const& stop,
            gi::Report& report, ArSummary& summary);

struct Spread {
    double median = 0, p95 = 0, most = 0;
};
Spread spread_of(std::vector<double> values);

/// Median, 95 % and most of each stage, frames per second, latency, poses: lines of text.
std::string describe(ArSummary const& summary);

} // namespace viewer
