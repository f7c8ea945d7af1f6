#pragma once
// Times that can be trusted a little: the median of several, with their spread, and competitors taking turns.

#include <functional>
#include <span>
#include <vector>

namespace viewer {

/// What was measured `repeats` times.
struct Measured {
    double median = 0, min = 0, max = 0;
    int repeats = 0;
};

/// Of any values. Throws on none.
Measured summarise(std::span<double const> values);
/// Of numerator[i] / denominator[i]: what was measured in the same round is compared.
Measured ratio(std::span<double const> numerator, std::span<double const> denominator);

/// Seconds of wall time.
double seconds_of(std::function<void()> const& work);
/// Seconds of `repeats` calls, after one that is not counted.
Measured measure(int repeats, std::function<void()> const& work);
/// Seconds per competitor and round: A B C, B C A, C A B, ... so that a ratio comes from one run and nobody always
/// goes first. One round before that is not counted.
std::vector<std::vector<double>> measure_interleaved(int repeats,
                                                     std::vector<std::function<void()>> const& competitors);

} // namespace viewer
