#include "tests/support/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gi::test {
namespace {

/// Regularised upper incomplete gamma function Q(a, x): series below a + 1, continued fraction above (Press et
/// al., Numerical Recipes, sec. 6.2).
double upper_gamma(double a, double x)
{
    if (x <= 0) return 1;
    double const scale = std::exp(-x + a * std::log(x) - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; n < 10000 && term > sum * 1e-16; ++n) sum += term *= x / (a + n);
        return 1 - sum * scale;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int i = 1; i < 10000; ++i) {
        double const an = -i * (i - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        double const delta = d * c;
        h *= delta;
        if (std::abs(delta - 1) < 1e-15) break;
    }
    return h * scale;
}

} // namespace

double chi_square_tail(double statistic, double degrees_of_freedom)
{
    return upper_gamma(0.5 * degrees_of_freedom, 0.5 * statistic);
}

double chi_square_p(std::vector<double> const& observed, std::vector<double> const& expected)
{
    double const total = std::accumulate(observed.begin(), observed.end(), 0.0);
    double impossible = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
        if (expected[i] == 0) impossible += observed[i];
    if (impossible > 1e-5 * total) return 0;

    std::vector<std::size_t> order(expected.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
    double statistic = 0, pooled_observed = 0, pooled_expected = 0;
    int groups = 0;
    for (std::size_t const i : order) {
        pooled_observed += observed[i];
        pooled_expected += expected[i];
        if (pooled_expected < 5) continue;
        double const difference = pooled_observed - pooled_expected;
        statistic += difference * difference / pooled_expected;
        ++groups;
        pooled_observed = pooled_expected = 0;
    }
    return groups < 2 ? 1 : chi_square_tail(statistic, groups - 1);
}

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

double sidak_level(double level, std::size_t n) { return -std::expm1(std::log1p(-level) / double(n)); }

void RunningMean::add(double x)
{
    ++count_;
    double const before = x - mean_;
    mean_ += before / double(count_);
    squares_ += before * (x - mean_);
}

double RunningMean::sigma() const { return std::sqrt(squares_ / (double(count_) * double(count_ - 1))); }

} // namespace gi::test
