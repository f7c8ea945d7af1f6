#pragma once
// Records of the frames of a sequence: statistics, and the metadata by which a frame on disk is known to be the one that
// would be rendered now.

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

/// Metadata of a frame: those of a picture, its number, and what identifies the render that it belongs to: stop
/// condition, the requested layers, and a fingerprint of world, camera and settings.
/// @param motion  fingerprint of the motion while the shutter is open; 0 = none
std::map<std::string, std::string> frame_metadata(RenderOptions const& options, gi::RenderSettings const& settings,
                                                  gi::RenderResult const& result, int frame,
                                                  std::uint64_t fingerprint, std::uint64_t motion);

/// First difference between a frame on disk and the wanted one ("its seed is 1, not 0"); empty = none.
/// @param wanted  from frame_metadata; values that are known only after rendering are not compared
std::string difference(gi::Picture const& there, std::map<std::string, std::string> const& wanted);

} // namespace viewer
