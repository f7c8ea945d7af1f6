#include "viewer/bench/measure.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace viewer {

Measured summarise(std::span<double const> values)
{
    if (values.empty()) throw std::logic_error("nothing was measured");
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    std::size_t const n = sorted.size();
    double const median = n % 2 == 1 ? sorted[n / 2] : 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]);
    return {median, sorted.front(), sorted.back(), int(n)};
}

Measured ratio(std::span<double const> numerator, std::span<double const> denominator)
{
    if (numerator.size() != denominator.size()) throw std::logic_error("a ratio needs as many of both");
    std::vector<double> ratios;
    for (std::size_t i = 0; i < numerator.size(); ++i) ratios.push_back(numerator[i] / denominator[i]);
    return summarise(ratios);
}

double seconds_of(std::function<void()> const& work)
{
    auto const start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Measured measure(int repeats, std::function<void()> const& work)
{
    return summarise(measure_interleaved(repeats, {work}).front());
}

std::vector<std::vector<double>> measure_interleaved(int repeats,
                                                     std::vector<std::function<void()>> const& competitors)
{
    for (auto const& work : competitors) work();
    std::size_t const n = competitors.size();
    std::vector<std::vector<double>> seconds(n);
    for (int round = 0; round < repeats; ++round)
        for (std::size_t i = 0; i < n; ++i) {
            std::size_t const turn = (std::size_t(round) + i) % n;
            seconds[turn].push_back(seconds_of(competitors[turn]));
        }
    return seconds;
}

} // namespace viewer
