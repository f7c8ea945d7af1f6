#pragma once
// Mean and spread of plain numbers; their quantiles are in gi/core/quantile.h.

#include <span>
#include <vector>

namespace study {

/// NaN of nothing.
double mean(std::span<double const> values);
/// With n - 1; NaN of fewer than two.
double standard_deviation(std::span<double const> values);

} // namespace study
