#pragma once
#include "gi/core/report.h"
#include "gi/filter/temporal.h"
#include "gi/render/render_settings.h"
#include "viewer/offline/frame_options.h"

#include <nlohmann/json.hpp>

namespace viewer {

/// What --stats says of one frame.
struct FrameRecord {
    int frame = 0;
    bool reused = false;     ///< was there already
    double seconds = 0;      ///< world, paths, filter and files; 0 where reused
    gi::RenderResult result; ///< without its picture
    std::map<std::string, gi::Report::Loss> losses;
    std::vector<std::string> changes; ///< of the world since the frame before; with --reuse
    gi::TemporalCounts reuse;         ///< likewise
};

/// For a message to another rank, and from one; without what --reuse knows.
nlohmann::json to_message(FrameRecord const& record);
FrameRecord record_of(nlohmann::json const& message);

/// An array with an object per frame.
nlohmann::ordered_json to_json(std::vector<FrameRecord> const& records, FrameSettings const& frames);
/// Seconds of the frames that were rendered: median, p95, p99 (gi/core/quantile.h), most, total; null where there
/// are none.
nlohmann::ordered_json frame_seconds(std::vector<FrameRecord> const& records);

} // namespace viewer
