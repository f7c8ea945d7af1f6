#pragma once
// Statistics of the frames of a sequence.

#include "gi/core/report.h"
#include "gi/filter/temporal.h"
#include "gi/render/render_settings.h"
#include "viewer/offline/frame_options.h"

#include <nlohmann/json.hpp>

namespace viewer {

/// Statistics of one frame, for --stats.
struct FrameRecord {
    int frame = 0;
    bool reused = false;     ///< existed already
    double seconds = 0;      ///< time of world, paths, filter and files; 0 if reused
    gi::RenderResult result; ///< without its picture
    std::map<std::string, gi::Report::Loss> losses;
    std::vector<std::string> changes; ///< of the world since the previous frame; only with --reuse
    gi::TemporalCounts reuse;         ///< only with --reuse
};

/// Converts to and from messages between ranks; without the members for --reuse.
nlohmann::json to_message(FrameRecord const& record);
FrameRecord record_of(nlohmann::json const& message);

/// JSON array with one object per frame.
nlohmann::ordered_json to_json(std::vector<FrameRecord> const& records, FrameSettings const& frames);
/// Seconds of the rendered frames: median, p95, p99 (gi/core/quantile.h), most, total; null if there are none.
nlohmann::ordered_json frame_seconds(std::vector<FrameRecord> const& records);

} // namespace viewer
