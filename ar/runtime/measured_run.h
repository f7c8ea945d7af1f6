#pragma once
// One session at one quality, measured: how fast, how late, how far from the truth. At own pace frames of files
// are read before, and come again and again as a camera would give them.

#include "ar/runtime/ar_window.h"
#include "ar/runtime/frame_truth.h"

namespace viewer {

struct MeasuredRun {
    /// As fast as possible and at the camera's own pace; without the first frame of each, which builds what lasts.
    std::vector<ArFrameRecord> fast, own;
    double frames_per_s = 0;     ///< as fast as possible, between the first frame's end and the last's
    std::uint64_t overtaken = 0; ///< at own pace
    std::uint64_t refused = 0;   ///< by the source or by the pipeline, as fast as possible
    FrameErrors errors;          ///< of what came out as fast as possible
    /// The last composite's parts (without a pair if there is no composite), and what puts them together.
    ArResult last;
    std::optional<ar::Compositor> compositor;
};

struct MeasureSettings {
    int frames = 20;                         ///< at most of files, and as many at own pace
    std::filesystem::path truth, true_poses; ///< folder, file; empty = not known
    bool in_window = false;                  ///< at own pace
};

/// @throws gi::InputError the source was lost; the session's tracker is live
/// @param stop  then what is measured so far comes back
MeasuredRun measure_run(ArSession const& session, MeasureSettings const& settings, gi::StopRequest& stop,
                        gi::Report& report);

} // namespace viewer
