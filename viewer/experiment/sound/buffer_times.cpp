#include "viewer/experiment/sound/buffer_times.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace viewer {

/// The median of the last reports of when the stream's first sample left, with this one.
double BufferTimes::smoothed_start(double start_s)
{
    constexpr double kJump_s = 0.02; // the device has stopped between, which it does not always say
    if (reports_ > 0 && std::abs(start_s - start_) > kJump_s) reports_ = 0;
    starts_[reports_++ % starts_.size()] = start_s;
    std::array<double, 64> sorted = starts_;
    auto const end = sorted.begin() + std::ptrdiff_t(std::min(reports_, sorted.size()));
    auto const middle = sorted.begin() + (end - sorted.begin()) / 2;
    std::nth_element(sorted.begin(), middle, end);
    return start_ = *middle;
}

double BufferTimes::first_s(Asked const& asked, std::size_t frames)
{
    if (asked.has_underrun) reports_ = 0; // the device has played silence between
    double at_s = asked.steady_s + asked.latency_s;
    if (asked.has_clock) {
        // The clock was read a little before this call: the least difference is the nearest.
        double const difference = asked.steady_s - asked.device_s;
        next_offset_s_ = std::min(next_offset_s_, difference);
        if (++since_offset_ * frames > std::size_t(2 * rate_hz_)) {
            offset_s_ = std::exchange(next_offset_s_, difference);
            since_offset_ = 0;
        }
        offset_s_ = std::min(offset_s_, difference);
        at_s = asked.leaves_device_s + offset_s_;
    }
    double const before_s = frames_done_ / rate_hz_;
    frames_done_ += double(frames);
    return smoothed_start(at_s - before_s) + before_s;
}

} // namespace viewer
