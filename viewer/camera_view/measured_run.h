#pragma once
// Measures one session at one quality: speed, latency and error against the truth. At own pace, frames of files
// are loaded beforehand and played in a loop as a camera would deliver them.

#include "ar/runtime/flicker.h"
#include "ar/runtime/frame_truth.h"
#include "viewer/camera_view/ar_window.h"

namespace viewer {

struct MeasuredRun {
    /// As fast as possible and at the camera's own pace; without the first frame of each, which includes set-up.
    std::vector<ar::RunFrame> fast, own;
    double frames_per_s = 0;     ///< as fast as possible, between the first frame's end and the last's
    std::uint64_t overtaken = 0; ///< at own pace
    std::uint64_t refused = 0;   ///< by the source or by the pipeline, in the fast run
    ar::FrameErrors errors;      ///< of the fast run's composites
    ar::Flicker flicker;         ///< of the first frame with a pose, shown again and again
    /// The last composite's parts (without a pair if there is no composite), and its compositor.
    ar::FrameResult last;
    std::optional<ar::Compositor> compositor;
    bool is_prefiltered = false; ///< lit by prefiltered light
};

struct MeasureSettings {
    int frames = 20;                         ///< maximum from files, and the number at own pace
    std::filesystem::path truth, true_poses; ///< folder, file; empty = unknown
    bool in_window = false;                  ///< at own pace
    int still_frames = 0;                    ///< for the flicker; fewer than 2: not measured
};

/// @throws gi::InputError if the source was lost, or the session's tracker is live
/// @param stop  on request, returns the measurements so far
MeasuredRun measure_run(ar::Session const& session, MeasureSettings const& settings, gi::StopRequest& stop,
                        gi::Report& report);

} // namespace viewer
