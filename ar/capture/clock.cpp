#include "ar/capture/clock.h"

#include <chrono>
#include <ctime>
#include <thread>

namespace ar {
namespace {

constexpr double kMostAge_s = 10;
constexpr double kSlack_s = 0.002; // the two clocks are not read at the same instant

double read_clock(clockid_t clock)
{
    timespec t{};
    clock_gettime(clock, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

} // namespace

double steady_now_s()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void sleep_until_s(double steady_s)
{
    double const left = steady_s - steady_now_s();
    if (left > 0) std::this_thread::sleep_for(std::chrono::duration<double>(left));
}

DriverClocks driver_clocks() { return {read_clock(CLOCK_MONOTONIC), read_clock(CLOCK_BOOTTIME)}; }

std::optional<double> steady_time_of(std::int64_t stamp_ns, DriverClocks const& now)
{
    if (stamp_ns <= 0) return std::nullopt;
    double const stamp_s = 1e-9 * double(stamp_ns);
    for (double const clock_s : {now.monotonic_s, now.boottime_s}) {
        double const age_s = clock_s - stamp_s;
        if (age_s >= -kSlack_s && age_s <= kMostAge_s) return now.monotonic_s - age_s;
    }
    return std::nullopt;
}

} // namespace ar
