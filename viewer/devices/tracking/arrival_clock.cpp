#include "viewer/devices/tracking/arrival_clock.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

constexpr double kPhase = 0.1, kPeriod = 0.0025; // critically damped
constexpr double kJitter = 0.02;

} // namespace

double ArrivalClock::note(double received_s)
{
    double const interval = received_s - received_s_;
    received_s_ = received_s;
    if (count_ == 0 || interval > kPause || interval < 0 || std::abs(received_s - time_s_) > kPause) {
        count_ = 1;
        period_s_ = jitter_s_ = 0;
        return time_s_ = received_s;
    }
    // Use the gains of a line fit through all samples so far, until they are as small as those of the loop.
    double const n = count_++, all = (n + 1) * (n + 2);
    double const expected = time_s_ + period_s_, error = received_s - expected;
    jitter_s_ += std::max(kJitter, 1 / n) * (std::abs(error) - jitter_s_);
    period_s_ = std::max(0.0, period_s_ + std::max(kPeriod, 6 / all) * error);
    double const next = expected + std::max(kPhase, 2 * (2 * n + 1) / all) * error;
    time_s_ = std::max(next, time_s_ + std::max(0.2 * period_s_, 1e-4));
    return time_s_;
}

double ArrivalClock::trust() const
{
    return period_s_ > 0 ? std::clamp(2 - 4 * jitter_s_ / period_s_, 0.0, 1.0) : 1;
}

} // namespace viewer
