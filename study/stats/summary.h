#pragma once
// Mean, spread and quantiles of plain numbers.

#include <span>
#include <vector>

namespace study {

/// NaN of nothing.
double mean(std::span<double const> values);
/// With n - 1; NaN of fewer than two.
double standard_deviation(std::span<double const> values);
/// The quantile of Hazen 1914 (number 5 of Hyndman & Fan 1996, Amer. Stat. 50:361): the k-th of n sorted values is
/// at (k - 0.5) / n, linear in between. NaN of nothing. @param p in [0, 1]
double quantile(std::vector<double> values, double p);

} // namespace study
