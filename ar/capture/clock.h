#pragma once
// Converts camera times to the program's clock: std::chrono::steady_clock, which is CLOCK_MONOTONIC on Linux.

#include "ar/camera/frame.h"

#include <cstdint>
#include <optional>

namespace ar {

/// Current time of the steady clock, seconds.
double steady_now_s();
/// Sleeps until that time; returns at once if it is past.
void sleep_until_s(double steady_s);

/// The two clocks that drivers use for timestamps, read at the same moment. Boot time advances while the machine
/// is suspended, monotonic time does not: they differ by the total time suspended since boot.
struct DriverClocks {
    double monotonic_s = 0, boottime_s = 0;
};
DriverClocks driver_clocks();

/// Steady time of a driver's timestamp. Drivers do not report which clock they used. A boot-time stamp lies in the
/// future of the monotonic clock if the machine was ever suspended; if it never was, both clocks agree. So a stamp
/// is monotonic unless it is in that clock's future, else boot time. Nothing if it fits neither clock: 0, ahead of
/// both, or more than 10 s old (buffers never are).
std::optional<double> steady_time_of(std::int64_t stamp_ns, DriverClocks const& now);

} // namespace ar
