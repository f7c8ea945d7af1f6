#pragma once
// Hypothesis tests for samplers and estimators.

#include <cstddef>
#include <vector>

namespace gi::test {

/// P(X >= statistic) of a chi-square distribution.
double chi_square_tail(double statistic, double degrees_of_freedom);
/// p-value of observed against expected counts (same sum up to noise). Bins are pooled, from the smallest on,
/// until each group expects at least 5; 0 where more than one in 100,000 fell into bins that expect nothing.
double chi_square_p(std::vector<double> const& observed, std::vector<double> const& expected);
/// P(Z <= z) of the standard normal distribution.
double normal_cdf(double z);
/// Level for one of n tests so that all together have `level` (Sidak 1967).
double sidak_level(double level, std::size_t n);

/// Mean of independent numbers and its standard error.
class RunningMean {
public:
    void add(double x);
    double mean() const { return mean_; }
    double sigma() const; ///< of the mean; needs two numbers

private:
    std::size_t count_ = 0;
    double mean_ = 0, squares_ = 0; ///< squares of the differences from the mean (Welford 1962)
};

} // namespace gi::test
