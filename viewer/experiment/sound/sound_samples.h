#pragma once
#include <cstddef>
#include <vector>

namespace viewer {

/// A stereo sound: two channels, interleaved left, right.
struct SoundSamples {
    std::vector<float> samples; ///< -1 to 1
    int rate_hz = 48000;
    std::size_t frames() const { return samples.size() / 2; }
    double duration_s() const { return double(frames()) / rate_hz; }
};

} // namespace viewer
