#pragma once
// Time measurements: the median of several with their range, and interleaved measurement of competitors.

#include <functional>
#include <span>
#include <vector>

namespace viewer {

/// Result of `repeats` measurements.
struct Measured {
    double median = 0, min = 0, max = 0;
    int repeats = 0;
};

/// Summarises any values. Throws if there are none.
Measured summarise(std::span<double const> values);
/// Summarises numerator[i] / denominator[i], i.e. ratios within the same round.
Measured ratio(std::span<double const> numerator, std::span<double const> denominator);

/// Wall-clock time of a call, s.
double seconds_of(std::function<void()> const& work);
/// Seconds of `repeats` calls, after one call that is not measured.
Measured measure(int repeats, std::function<void()> const& work);
/// Seconds per competitor and round, in the order A B C, B C A, C A B, ..., so that ratios come from the same run
/// and no competitor is always first. One earlier round is not measured.
std::vector<std::vector<double>> measure_interleaved(int repeats,
                                                     std::vector<std::function<void()>> const& competitors);

} // namespace viewer
