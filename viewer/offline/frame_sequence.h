#pragma once
// A sequence of frames as files and a video. It can be interrupted at any time: complete frames stay, and
// RenderOptions::resume renders the missing ones.

#include "viewer/offline/load_world.h"
#include "viewer/offline/rank_work.h"

#include <nlohmann/json.hpp>

namespace viewer {

/// Of the leading process; of others empty.
struct FramesEnd {
    bool complete = false;
    nlohmann::ordered_json stats;   ///< for --stats and --json
    std::vector<std::string> lines; ///< the same for people: files and times
    std::vector<std::string> notes; ///< what is missing, and how to go on
};

/// Writes every frame to its files and all frames to a video. With several processes each renders every size-th frame;
/// the leading one writes the video. Ends early at the stop request of `work`. @param report  of all frames together
FramesEnd render_frames(RenderOptions const& options, gi::RenderSettings const& settings,
                        gi::DenoiseSettings const& denoise_settings, CameraChoice const& choice, RankWork& work,
                        gi::Report& report);

} // namespace viewer
