#include "study/stats/binomial.h"

#include "study/numeric/error.h"
#include "study/numeric/special.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace study {
namespace {

void check(double k, double n)
{
    if (!(k >= 0 && k <= n && std::isfinite(n)))
        refuse(std::to_string(k) + " of " + std::to_string(n) + " trials",
               "successes are numbers from 0 to the number of trials", "give counts of the same trials");
}

void check(double k, double n, double confidence)
{
    check(k, n);
    if (!(confidence > 0 && confidence < 1))
        refuse("confidence " + std::to_string(confidence), "it is a probability", "use 0.95 for 95 %");
}

} // namespace

Interval wilson(double k, double n, double confidence)
{
    check(k, n, confidence);
    if (n == 0) return {0, 1};
    double const z = normal_quantile(0.5 + confidence / 2), p = k / n, z2n = z * z / n;
    double const centre = (p + z2n / 2) / (1 + z2n);
    double const half = z / (1 + z2n) * std::sqrt(p * (1 - p) / n + z2n / (4 * n));
    return {k == 0 ? 0 : std::max(0.0, centre - half), k == n ? 1 : std::min(1.0, centre + half)};
}

double log_binomial(double k, double n, double p)
{
    check(k, n);
    double const hits = k == 0 ? 0 : k * std::log(p);
    double const misses = k == n ? 0 : (n - k) * std::log1p(-p);
    return log_choose(n, k) + hits + misses;
}

double binomial_test(int k, int n, double p)
{
    check(k, n);
    if (!(p >= 0 && p <= 1))
        refuse("probability " + std::to_string(p), "it lies in [0, 1]", "give the one to test");
    double const limit = log_binomial(k, n, p) + 1e-7; // so that rounding does not omit the mirrored outcome
    double sum = 0;
    for (int i = 0; i <= n; ++i)
        if (double const l = log_binomial(i, n, p); l <= limit) sum += std::exp(l);
    return std::min(1.0, sum);
}

} // namespace study
