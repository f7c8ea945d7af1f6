#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>

namespace study {

double mean(std::span<double const> values)
{
    double sum = 0;
    for (double const v : values) sum += v;
    return sum / double(values.size());
}

double standard_deviation(std::span<double const> values)
{
    if (values.size() < 2) return std::nan("");
    double const m = mean(values);
    double squares = 0;
    for (double const v : values) squares += (v - m) * (v - m);
    return std::sqrt(squares / double(values.size() - 1));
}

double quantile(std::vector<double> values, double p)
{
    if (values.empty()) return std::nan("");
    std::sort(values.begin(), values.end());
    double const last = double(values.size() - 1);
    double const at = std::clamp(p * double(values.size()) - 0.5, 0.0, last);
    auto const below = std::size_t(at);
    double const share = at - double(below);
    return share == 0 ? values[below] : values[below] * (1 - share) + values[below + 1] * share;
}

} // namespace study
