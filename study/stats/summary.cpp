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

} // namespace study
