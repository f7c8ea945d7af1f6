#include "viewer/experiment/screens/refresh.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <vector>

namespace viewer {

int dropped_between(double seconds, double period_s)
{
    if (!(period_s > 0) || !(seconds > kLate * period_s)) return 0;
    return std::max(1, int(std::lround(seconds / period_s)) - 1);
}

study::CalibrationDone judge_refresh(std::span<double const> swaps_s, double nominal_hz,
                                     study::Timing const& timing, std::string const& onset_method)
{
    study::CalibrationDone done;
    done.onset_method = onset_method;
    done.nominal_hz = nominal_hz;
    done.frames = int(swaps_s.size());
    if (swaps_s.size() < 3) {
        done.reason = "fewer than 3 frames were shown";
        return done;
    }
    std::vector<double> ms(swaps_s.size());
    std::adjacent_difference(swaps_s.begin(), swaps_s.end(), ms.begin(),
                             [](double later, double earlier) { return 1e3 * (later - earlier); });
    ms.erase(ms.begin());
    double const n = double(ms.size());
    done.period_mean_ms = std::accumulate(ms.begin(), ms.end(), 0.0) / n;
    double squares = 0;
    for (double const v : ms) squares += (v - done.period_mean_ms) * (v - done.period_mean_ms);
    done.period_sd_ms = std::sqrt(squares / (n - 1));
    double const period_ms = 1e3 / (nominal_hz > 0 ? nominal_hz : timing.expected_hz);
    double const deviation = std::abs(done.period_mean_ms - period_ms) / period_ms;
    if (deviation > timing.calibrate.max_deviation)
        done.reason =
            fmt::format("swaps come every {:.3g} ms instead of {:.3g} ms{}{}", done.period_mean_ms, period_ms,
                        nominal_hz > 0 ? "" : " (timing.expected_hz: the display does not report its rate)",
                        done.period_mean_ms < 0.5 * period_ms ? ": they do not wait for the display" : "");
    else if (done.period_sd_ms > timing.calibrate.max_sd_ms)
        done.reason = fmt::format("the intervals of swaps have a standard deviation of {:.3g} ms (at most {:.3g})",
                                  done.period_sd_ms, timing.calibrate.max_sd_ms);
    done.passed = done.reason.empty();
    return done;
}

} // namespace viewer
