#pragma once
// When the buffers of a sound device leave it, by the steady clock, from what the device says of each.
//
// The device says by its own clock when a buffer's first sample reaches the converter. That clock is mapped to the steady
// clock by the least difference seen in the last seconds, and the buffers' times are smoothed by their median relative to
// the count of samples: single late or wrong reports do not count.

#include <array>
#include <cstddef>
#include <limits>

namespace viewer {

class BufferTimes {
public:
    explicit BufferTimes(int rate_hz) : rate_hz_(rate_hz) {}

    /// What is known when the device asks for a buffer, s.
    struct Asked {
        double steady_s;                  ///< steady clock
        bool has_clock;                   ///< the device has one
        double device_s, leaves_device_s; ///< its clock: now, and as the buffer's first sample leaves
        double latency_s;                 ///< of the device, which holds where it has no clock
        bool has_underrun;                ///< since the buffer before
    };
    /// When the first sample of the next buffer leaves, s, steady clock. @param frames  of the buffer
    double first_s(Asked const& asked, std::size_t frames);
    bool is_known() const { return reports_ >= 8; }

private:
    double smoothed_start(double start_s);

    int rate_hz_;
    double frames_done_ = 0;
    std::array<double, 64> starts_{}; ///< of the stream's first sample, as each of the last buffers says
    double start_ = 0;                ///< their median
    std::size_t reports_ = 0;
    static constexpr double kInfinite = std::numeric_limits<double>::infinity();
    double offset_s_ = kInfinite,
           next_offset_s_ = kInfinite; ///< steady minus device's clock: least of the last buffers
    std::size_t since_offset_ = 0;
};

} // namespace viewer
