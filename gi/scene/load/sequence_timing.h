#pragma once
// When each frame of a mesh sequence is shown.

#include "gi/core/report.h"

#include <filesystem>
#include <string>
#include <vector>

namespace gi {

/// Times of the frames of a mesh sequence.
struct SequenceTiming {
    std::vector<float> times_s; ///< one per frame, strictly increasing, >= 0
    double period_s = 0;        ///< >= the last time
    bool loop = true;
    std::string file; ///< source of the timing; empty = none
};

/// Reads the folder's sequence.json: `times_s` (one per frame) since `t0_s` (default 0), or `fps`; `duration_s`
/// (the period) and `loop`; keys that only describe the origin of the frames are ignored. Without the file, or
/// without times in it: 24 frames per second, looping. The default period is one mean step longer than the last
/// time. Throws InputError if the file contradicts itself or the frames.
SequenceTiming read_sequence_timing(std::filesystem::path const& folder, std::size_t frames, Report& report);

} // namespace gi
