#pragma once
// The curves of psychometric functions.

#include "study/adaptive/psychometric_curve.h"
#include "study/numeric/special.h"

#include <cmath>
#include <numbers>

namespace study {

inline constexpr double kPi = std::numbers::pi;

/// F(z), 1 - F(z) without cancellation, and dF/dz.
struct SigmoidValue {
    double below, above, density;
};

inline SigmoidValue sigmoid(Sigmoid kind, double z)
{
    switch (kind) {
    case Sigmoid::gaussian:
        return {normal_cdf(z), normal_cdf(-z), normal_pdf(z)};
    case Sigmoid::weibull: {
        double const e = std::exp(std::fmin(z, 700));
        return {-std::expm1(-e), std::exp(-e), std::exp(z - e)};
    }
    case Sigmoid::gumbel_right: {
        SigmoidValue const left = sigmoid(Sigmoid::weibull, -z);
        return {left.above, left.below, left.density};
    }
    case Sigmoid::hyperbolic_secant: {
        double const half = kPi / 2, e = std::exp(-std::abs(half * z)), small = std::atan(e) / half;
        double const density = e / (1 + e * e);
        return z > 0 ? SigmoidValue{1 - small, small, density} : SigmoidValue{small, 1 - small, density};
    }
    case Sigmoid::cauchy:
        return {std::atan2(1, -z) / kPi, std::atan2(1, z) / kPi, 1 / (kPi * (1 + z * z))};
    case Sigmoid::logistic:
        break;
    }
    double const e = std::exp(-std::abs(z)), small = e / (1 + e), large = 1 / (1 + e);
    return z > 0 ? SigmoidValue{large, small, small * large} : SigmoidValue{small, large, small * large};
}

/// The z with F(z) = f, f in (0, 1).
inline double sigmoid_quantile(Sigmoid kind, double f)
{
    switch (kind) {
    case Sigmoid::gaussian:
        return normal_quantile(f);
    case Sigmoid::weibull:
        return std::log(-std::log1p(-f));
    case Sigmoid::gumbel_right:
        return -std::log(-std::log(f));
    case Sigmoid::hyperbolic_secant:
        return 2 / kPi * std::log(std::tan(kPi / 2 * f));
    case Sigmoid::cauchy:
        return std::tan(kPi * (f - 0.5));
    case Sigmoid::logistic:
        break;
    }
    return std::log(f / (1 - f));
}

} // namespace study
