#include "study/stats/special.h"

#include "study/stats/root.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace study {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kEpsilon = 1e-16;

/// The continued fraction of Q(a, x), by Lentz's method, without its leading factor.
double gamma_fraction(double a, double x)
{
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int i = 1; i < 100000; ++i) {
        double const an = -i * (i - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        double const factor = c * d;
        h *= factor;
        if (std::abs(factor - 1) < kEpsilon) break;
    }
    return h;
}

double gamma_series(double a, double x)
{
    double term = 1 / a, sum = term;
    for (double n = a + 1; term > sum * kEpsilon; ++n) {
        term *= x / n;
        sum += term;
    }
    return sum;
}

double gamma_factor(double a, double x) { return std::exp(a * std::log(x) - x - log_gamma(a)); }

/// Lentz's method for I_x(a, b) a B(a, b) / (x^a (1-x)^b); converges fast for x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x)
{
    auto const away_from_zero = [](double v) { return std::abs(v) < 1e-300 ? 1e-300 : v; };
    double c = 1, d = 1 / away_from_zero(1 - (a + b) * x / (a + 1)), h = d;
    for (int m = 1; m < 100000; ++m) {
        double const even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1 / away_from_zero(1 + even * d);
        c = away_from_zero(1 + even / c);
        h *= d * c;
        double const odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / away_from_zero(1 + odd * d);
        c = away_from_zero(1 + odd / c);
        h *= d * c;
        if (std::abs(d * c - 1) < kEpsilon) break;
    }
    return h;
}

} // namespace

double normal_pdf(double z) { return std::exp(-0.5 * z * z) * 0.3989422804014326779; }

double normal_cdf(double z) { return 0.5 * std::erfc(-z * (0.5 * std::numbers::sqrt2)); }

double log_normal_cdf(double z)
{
    if (z > 5) return std::log1p(-normal_cdf(-z));
    if (!(z < -30)) return std::log(normal_cdf(z));
    double const s = 1 / (z * z);
    return -0.5 * z * z - std::log(-z) - 0.9189385332046727418 +
           std::log1p(-s * (1 - s * (3 - s * (15 - s * 105))));
}

double normal_quantile(double p)
{
    if (!(p >= 0 && p <= 1)) return kNaN;
    if (p == 0 || p == 1) return p == 0 ? -kInfinity : kInfinity;
    if (p == 0.5) return 0;
    if (p > 0.5) return -normal_quantile(1 - p);
    // A start accurate to 4.5e-4 (A&S 26.2.23), then Newton's method on log Phi.
    double const target = std::log(p), t = std::sqrt(-2 * target);
    double z =
        (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308))) - t;
    for (int i = 0; i < 4; ++i) {
        double const log_cdf = log_normal_cdf(z);
        z -= (log_cdf - target) * std::exp(log_cdf + 0.5 * z * z + 0.9189385332046727418);
    }
    return z;
}

double log_gamma(double x) { return std::lgamma(x); }

double log_choose(double n, double k) { return log_gamma(n + 1) - log_gamma(k + 1) - log_gamma(n - k + 1); }

double gamma_q(double a, double x)
{
    if (!(a > 0 && x >= 0)) return kNaN;
    if (x == 0) return 1;
    if (x == kInfinity) return 0;
    return x < a + 1 ? 1 - gamma_series(a, x) * gamma_factor(a, x) : gamma_fraction(a, x) * gamma_factor(a, x);
}

double beta_i(double a, double b, double x)
{
    if (!(a > 0 && b > 0 && x >= 0 && x <= 1)) return kNaN;
    if (x == 0 || x == 1) return x;
    double const factor =
        std::exp(log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * std::log(x) + b * std::log1p(-x));
    if (x < (a + 1) / (a + b + 2)) return factor * beta_fraction(a, b, x) / a;
    return 1 - factor * beta_fraction(b, a, 1 - x) / b;
}

double chi_square_tail(double x, double degrees_of_freedom)
{
    if (std::isnan(x) || !(degrees_of_freedom >= 0)) return kNaN;
    if (x <= 0) return 1;
    return degrees_of_freedom == 0 ? 0 : gamma_q(degrees_of_freedom / 2, x / 2);
}

double student_cdf(double t, double degrees_of_freedom)
{
    double const n = degrees_of_freedom;
    if (std::isnan(t) || !(n > 0)) return kNaN;
    double const tail = std::isinf(t) ? 0 : 0.5 * beta_i(n / 2, 0.5, n / (n + t * t));
    return t > 0 ? 1 - tail : tail;
}

double student_quantile(double p, double degrees_of_freedom)
{
    if (!(p >= 0 && p <= 1 && degrees_of_freedom > 0)) return kNaN;
    if (p == 0 || p == 1) return p == 0 ? -kInfinity : kInfinity;
    if (p == 0.5) return 0;
    if (p > 0.5) return -student_quantile(1 - p, degrees_of_freedom);
    double low = -1;
    while (student_cdf(low, degrees_of_freedom) > p) low *= 2;
    return bisect([&](double t) { return student_cdf(t, degrees_of_freedom) - p; }, low, 0);
}

double normal_range_cdf(double w, int k)
{
    if (std::isnan(w) || k < 2) return kNaN;
    if (w <= 0) return 0;
    // The trapezium rule converges faster than any power of its step for such integrands.
    constexpr double kStep = 0.05, kEnd = 9;
    double sum = 0;
    for (double z = -kEnd; z < kEnd + kStep / 2; z += kStep)
        sum += normal_pdf(z) * std::pow(normal_cdf(z) - normal_cdf(z - w), k - 1);
    return std::fmin(1, k * sum * kStep);
}

double normal_range_quantile(double p, int k)
{
    if (!(p >= 0 && p <= 1) || k < 2) return kNaN;
    if (p == 0 || p == 1) return p == 0 ? 0 : kInfinity;
    double high = 1;
    while (normal_range_cdf(high, k) < p && high < 64) high *= 2;
    return bisect([&](double w) { return normal_range_cdf(w, k) - p; }, 0, high);
}

} // namespace study
