#pragma once
// Times of cameras on the one clock of the program: std::chrono::steady_clock, which is CLOCK_MONOTONIC on Linux.

#include "ar/camera/frame.h"

#include <cstdint>
#include <optional>

namespace ar {

/// Seconds of the steady clock.
double steady_now_s();
/// Sleeps until then (not at all if it is past).
void sleep_until_s(double steady_s);

/// Both clocks that drivers stamp frames with, read at one moment. Boot time goes on while the machine sleeps,
/// monotonic time does not: they differ by all sleep since the machine was started.
struct DriverClocks {
    double monotonic_s = 0, boottime_s = 0;
};
DriverClocks driver_clocks();

/// The steady time of a driver's stamp. Drivers do not say which clock it is of. A stamp of boot time lies in the
/// future of the monotonic clock if the machine ever slept, and if it never slept both are the same clock: so it
/// is monotonic if it is not in that clock's future, else boot time. Nothing where it fits neither: 0, ahead of
/// both, or more than 10 s old (what a buffer never is).
std::optional<double> steady_time_of(std::int64_t stamp_ns, DriverClocks const& now);

} // namespace ar
