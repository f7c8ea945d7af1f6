#pragma once
// d' from the proportions of one observer, by solving each model's equation (Macmillan & Creelman 2005; differencing observers): what
// detection_model.h is compared with.

#include "study/numeric/root.h"
#include "study/numeric/special.h"
#include "study/stats/dprime.h"

#include <cmath>
#include <numbers>

namespace study::test {

inline constexpr double kLargestDPrime = 40; ///< above it, proportions are 1 within rounding

/// H = Phi((d'-k)/sqrt 2) + Phi((-d'-k)/sqrt 2), F = 2 Phi(-k/sqrt 2). @param hit_rate, false_alarm_rate  of saying
/// "different" given different, given the same
inline double same_different_dprime(double hit_rate, double false_alarm_rate)
{
    double const root2 = std::numbers::sqrt2, k = -root2 * normal_quantile(false_alarm_rate / 2);
    return bisect([&](double d) { return normal_cdf((d - k) / root2) + normal_cdf((-d - k) / root2) - hit_rate; },
                  0, kLargestDPrime);
}

/// From the unbiased proportion correct p = Phi((z(H) - z(F)) / 2) with
/// p = Phi(d'/sqrt 2) Phi(d'/sqrt 6) + Phi(-d'/sqrt 2) Phi(-d'/sqrt 6).
inline double abx_dprime(double hit_rate, double false_alarm_rate)
{
    double const p = normal_cdf((normal_quantile(hit_rate) - normal_quantile(false_alarm_rate)) / 2);
    auto const correct = [](double d) {
        double const a = d / std::numbers::sqrt2, b = d / std::sqrt(6.0);
        return normal_cdf(a) * normal_cdf(b) + normal_cdf(-a) * normal_cdf(-b);
    };
    return bisect([&](double d) { return correct(d) - p; }, 0, kLargestDPrime);
}

inline double oddity_dprime(double proportion_correct)
{
    return bisect([&](double d) { return oddity_proportion(d) - proportion_correct; }, 0, kLargestDPrime);
}

} // namespace study::test
