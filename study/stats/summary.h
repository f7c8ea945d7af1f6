#pragma once
// Mean and standard deviation; for quantiles see gi/core/quantile.h.

#include <span>
#include <vector>

namespace study {

/// NaN if empty.
double mean(std::span<double const> values);
/// With n - 1; NaN for fewer than two values.
double standard_deviation(std::span<double const> values);

} // namespace study
