#pragma once
// Mean and standard deviation; for quantiles see gi/core/quantile.h.

#include "study/numeric/rounding.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace study {

/// NaN if empty. Of equal values exactly that value, and exact to the spread of values that are far from 0.
inline double mean(std::span<double const> values)
{
    if (values.empty()) return std::nan("");
    double sum = 0;
    for (double const v : values) sum += v - values.front();
    return values.front() + sum / double(values.size());
}

/// The largest magnitude; 0 without numbers.
inline double largest_of(std::span<double const> values)
{
    double largest = 0;
    for (double const v : values) largest = std::fmax(largest, std::abs(v));
    return largest;
}

/// With n - 1; NaN for fewer than two values; 0 where values differ by rounding alone.
/// @param size  magnitude of the numbers that the values were computed from, if it may be larger than theirs
inline double standard_deviation(std::span<double const> values, double size = 0)
{
    if (values.size() < 2) return std::nan("");
    double const m = mean(values);
    double squares = 0;
    for (double const v : values) squares += (v - m) * (v - m);
    double const sd = std::sqrt(squares / double(values.size() - 1));
    return without_rounding(sd, std::max(size, largest_of(values)));
}

} // namespace study
