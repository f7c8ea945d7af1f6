#include "study/stats/effect_size.h"

#include "study/numeric/error.h"
#include "study/numeric/root.h"
#include "study/numeric/special.h"
#include "study/stats/summary.h"

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_f.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <cmath>

namespace study {
namespace {

namespace bm = boost::math;

/// The noncentrality at which P(X <= x) has this value; `cdf` falls with the noncentrality.
template <class Cdf>
double noncentrality(Cdf const& cdf, double value, double low, double high)
{
    if (cdf(low) < value) return low;
    return bisect([&](double lambda) { return value - cdf(lambda); }, low, high);
}

} // namespace

double f_tail(double f, double df1, double df2)
{
    if (std::isnan(f) || !(df1 > 0) || !(df2 > 0)) return std::nan("");
    if (f <= 0) return 1;
    if (std::isinf(f)) return 0;
    return bm::cdf(bm::complement(bm::fisher_f(df1, df2), f));
}

Interval eta2_interval(double f, double df1, double df2, double confidence)
{
    if (!std::isfinite(f) || f < 0) return {std::nan(""), std::nan("")};
    double const tail = (1 - confidence) / 2;
    auto const eta2 = [&](double lambda) { return lambda / (lambda + df1 + df2 + 1); };
    // Beyond, as where all observers give the same answer, only the denominator's
    // chi squared varies in comparison.
    constexpr double kLarge = 1e6;
    if (f * df1 > kLarge) {
        auto const lambda = [&](double share) { return f * df1 * (chi_square_quantile(share, df2) / df2); };
        return {eta2(lambda(tail)), eta2(lambda(1 - tail))};
    }
    auto const cdf = [&](double lambda) {
        return lambda > 0 ? bm::cdf(bm::non_central_f(df1, df2, lambda), f) : 1 - f_tail(f, df1, df2);
    };
    double high = 10 + 4 * f * df1;
    while (cdf(high) > tail && high < 1e6) high *= 2;
    return {eta2(noncentrality(cdf, 1 - tail, 0, high)), eta2(noncentrality(cdf, tail, 0, high))};
}

WelchTest welch_test(std::span<double const> a, std::span<double const> b, double confidence)
{
    if (a.size() < 2 || b.size() < 2)
        refuse("groups of " + std::to_string(a.size()) + " and " + std::to_string(b.size()) + " observers",
               "a variance needs two", "test more observers");
    WelchTest w;
    w.n_a = int(a.size());
    w.n_b = int(b.size());
    w.mean_a = mean(a);
    w.mean_b = mean(b);
    w.difference = without_rounding(w.mean_a - w.mean_b, std::max(largest_of(a), largest_of(b)));
    double const size = std::max(largest_of(a), largest_of(b));
    double const sd_a = standard_deviation(a, size), sd_b = standard_deviation(b, size), n_a = w.n_a, n_b = w.n_b;
    double const part_a = sd_a * sd_a / n_a, part_b = sd_b * sd_b / n_b;
    w.standard_error = std::sqrt(part_a + part_b);
    if (!(w.standard_error > 0))
        refuse("no variation within groups", "there is nothing to compare with", "check the data");
    w.t = w.difference / w.standard_error;
    w.df = std::pow(part_a + part_b, 2) / (part_a * part_a / (n_a - 1) + part_b * part_b / (n_b - 1));
    w.p = 2 * student_cdf(-std::abs(w.t), w.df);
    double const half = student_quantile((1 + confidence) / 2, w.df) * w.standard_error;
    w.interval = {w.difference - half, w.difference + half};

    double const df = n_a + n_b - 2;
    double const pooled = std::sqrt(((n_a - 1) * sd_a * sd_a + (n_b - 1) * sd_b * sd_b) / df);
    double const correction = std::exp(std::lgamma(df / 2) - std::lgamma((df - 1) / 2)) / std::sqrt(df / 2);
    w.hedges_g = correction * w.difference / pooled;
    double const scale = std::sqrt(1 / n_a + 1 / n_b), t = w.difference / (pooled * scale);
    double const tail = (1 - confidence) / 2;
    if (constexpr double kLarge = 1e3; std::abs(t) > kLarge) { // as in eta2_interval()
        auto const delta = [&](double share) { return t * std::sqrt(chi_square_quantile(share, df) / df); };
        double const nearer = correction * scale * delta(tail), farther = correction * scale * delta(1 - tail);
        w.g = {std::min(nearer, farther), std::max(nearer, farther)};
        return w;
    }
    auto const cdf = [&](double delta) { return bm::cdf(bm::non_central_t(df, delta), t); };
    double const reach = 12 + std::abs(t);
    w.g = {correction * scale * noncentrality(cdf, 1 - tail, t - reach, t + reach),
           correction * scale * noncentrality(cdf, tail, t - reach, t + reach)};
    return w;
}

} // namespace study
