#include "viewer/report/measure.h"

#include "gi/core/quantile.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace viewer {

Measured summarise(std::span<double const> values)
{
    if (values.empty()) throw std::logic_error("nothing was measured");
    auto const [least, most] = std::minmax_element(values.begin(), values.end());
    return {gi::median(std::vector<double>(values.begin(), values.end())), *least, *most, int(values.size())};
}

Measured ratio(std::span<double const> numerator, std::span<double const> denominator)
{
    if (numerator.size() != denominator.size()) throw std::logic_error("a ratio needs equal numbers of both");
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
