#pragma once
// Special functions and distributions, by Boost.Math where it has them. Relative errors are near 1e-14 unless the
// result is tiny; tails keep their relative accuracy down to the smallest doubles. NaN in, NaN out.

#include <limits>

namespace study {

inline constexpr double kLogRootTwoPi = 0.9189385332046727418; ///< log(2 pi) / 2
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

double normal_pdf(double z);
double normal_cdf(double z);
/// log Phi(z); finite for all finite z, by the asymptotic series 26.2.12 of Abramowitz & Stegun 1964 below -30.
double log_normal_cdf(double z);
/// z with Phi(z) = p: -infinity at 0, infinity at 1, NaN outside [0, 1].
double normal_quantile(double p);

/// Owen's T (1956): the probability that a standard normal number exceeds h and another
/// one lies between 0 and a times it.
double owens_t(double h, double a);

double inverse_logit(double x); ///< 1 / (1 + exp(-x))

/// log of the binomial coefficient n over k, also for non-integers.
double log_choose(double n, double k);

/// P(X >= x) of a chi-square distribution; 1 if x <= 0. With no degrees of freedom X is 0.
double chi_square_tail(double x, double degrees_of_freedom);
double chi_square_quantile(double p, double degrees_of_freedom);
/// P(T <= t) of Student's distribution.
double student_cdf(double t, double degrees_of_freedom);
double student_quantile(double p, double degrees_of_freedom);
/// P(W <= w) of the range of k independent standard normal numbers, k >= 2:
/// k \int phi(z) (Phi(z) - Phi(z - w))^(k-1) dz (Pearson & Hartley 1942).
double normal_range_cdf(double w, int k);
double normal_range_quantile(double p, int k);

} // namespace study
