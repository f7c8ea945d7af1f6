#pragma once
// Statistics of the frame times of a whole session, in constant memory.

#include "viewer/protocol/recording/frame_times.h"

#include <nlohmann/json.hpp>

namespace viewer {

/// Statistics of the intervals between swaps, in ms. Percentiles (gi/core/quantile.h) are accurate
/// to 0.25 %, the other values exact.
struct FrameSummary {
    std::uint64_t frames = 0;
    double mean_ms = 0, p50_ms = 0, p95_ms = 0, p99_ms = 0, max_ms = 0; ///< 0 with fewer than two frames
    std::uint64_t dropped = 0, reprojected = 0;
};
nlohmann::ordered_json to_json(FrameSummary const& summary);

class FrameStatistics {
public:
    void add(FrameTimes const& times);
    FrameSummary summary() const;

private:
    // Bin i counts intervals from 1.005^i to 1.005^(i + 1) us; the first and last bins also count those beyond.
    static constexpr int kBins = 3700;            // to 100 s
    double interval_ms(std::uint64_t rank) const; ///< interval of this rank in ascending order, from 0
    double quantile_ms(double p) const;

    std::vector<std::uint64_t> bins_ = std::vector<std::uint64_t>(kBins);
    std::uint64_t frames_ = 0, intervals_ = 0, dropped_ = 0, reprojected_ = 0;
    double last_swap_s_ = 0, sum_ms_ = 0, max_ms_ = 0;
};

} // namespace viewer
