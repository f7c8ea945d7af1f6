#include "viewer/protocol/recording/frame_summary.h"

#include "gi/core/quantile.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

double const kLogStep = std::log(1.005);

} // namespace

nlohmann::ordered_json to_json(FrameSummary const& s)
{
    return {{"frames", s.frames}, {"mean_ms", s.mean_ms}, {"p50_ms", s.p50_ms},   {"p95_ms", s.p95_ms},
            {"p99_ms", s.p99_ms}, {"max_ms", s.max_ms},   {"dropped", s.dropped}, {"reprojected", s.reprojected}};
}

void FrameStatistics::add(FrameTimes const& t)
{
    if (frames_++ > 0) {
        double const ms = std::max(0.0, 1000 * (t.swap_s - last_swap_s_));
        double const bin = std::log(std::max(1000 * ms, 1.0)) / kLogStep;
        ++bins_[std::size_t(std::min(bin, kBins - 1.0))];
        ++intervals_;
        sum_ms_ += ms;
        max_ms_ = std::max(max_ms_, ms);
    }
    last_swap_s_ = t.swap_s;
    dropped_ += std::uint64_t(std::max(t.dropped, 0));
    reprojected_ += t.reprojected ? 1 : 0;
}

double FrameStatistics::interval_ms(std::uint64_t rank) const
{
    if (rank + 1 >= intervals_) return max_ms_;
    std::uint64_t up_to = 0;
    for (int i = 0; i < kBins; ++i) {
        up_to += bins_[std::size_t(i)];
        if (up_to > rank) return std::min(max_ms_, std::exp((i + 0.5) * kLogStep) / 1000);
    }
    return max_ms_;
}

double FrameStatistics::quantile_ms(double p) const
{
    gi::QuantilePlace const at = gi::quantile_place(intervals_, p);
    return gi::interpolated(interval_ms(at.below), interval_ms(at.below + 1), at.share);
}

FrameSummary FrameStatistics::summary() const
{
    FrameSummary s;
    s.frames = frames_;
    s.dropped = dropped_;
    s.reprojected = reprojected_;
    if (intervals_ == 0) return s;
    s.mean_ms = sum_ms_ / double(intervals_);
    s.p50_ms = quantile_ms(0.5);
    s.p95_ms = quantile_ms(0.95);
    s.p99_ms = quantile_ms(0.99);
    s.max_ms = max_ms_;
    return s;
}

} // namespace viewer
