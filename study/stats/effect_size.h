#pragma once
// Sizes of effects with intervals, and tests of two groups.

#include "study/stats/binomial.h"

#include <span>

namespace study {

/// P(F >= f) of the F distribution; 1 if f <= 0. NaN in, NaN out.
double f_tail(double f, double df1, double df2);

/// Interval of partial eta squared, lambda / (lambda + df1 + df2 + 1) with lambda from the noncentral F
/// distribution (Steiger 2004, Psychol. Methods 9:164; Smithson 2001).
Interval eta2_interval(double f, double df1, double df2, double confidence = 0.95);

/// Difference of the means of two groups with unequal variances (Welch 1947, Biometrika 34:28).
struct WelchTest {
    int n_a = 0, n_b = 0;
    double mean_a = 0, mean_b = 0;
    double difference = 0; ///< a - b
    double standard_error = 0, t = 0, df = 0, p = 1;
    Interval interval;
    double hedges_g = 0; ///< difference by the pooled deviation, without bias (Hedges 1981, J. Educ. Stat. 6:107)
    Interval g;          ///< by the noncentral t distribution
};
/// @throws std::invalid_argument fewer than two values in a group, no variation
WelchTest welch_test(std::span<double const> a, std::span<double const> b, double confidence = 0.95);

} // namespace study
