#pragma once
// Mean and standard deviation; for quantiles see gi/core/quantile.h.

#include <cmath>
#include <span>
#include <vector>

namespace study {

/// NaN if empty.
inline double mean(std::span<double const> values)
{
    double sum = 0;
    for (double const v : values) sum += v;
    return sum / double(values.size());
}

/// With n - 1; NaN for fewer than two values.
inline double standard_deviation(std::span<double const> values)
{
    if (values.size() < 2) return std::nan("");
    double const m = mean(values);
    double squares = 0;
    for (double const v : values) squares += (v - m) * (v - m);
    return std::sqrt(squares / double(values.size() - 1));
}

} // namespace study
