#include "study/numeric/special.h"

#include "study/numeric/root.h"

#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/special_functions/owens_t.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace study {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
using namespace boost::math::policies;
/// Results are NaN or infinite instead of exceptions.
using Quiet = policy<domain_error<ignore_error>, pole_error<ignore_error>, overflow_error<ignore_error>,
                     evaluation_error<ignore_error>, promote_double<false>>;
using Student = boost::math::students_t_distribution<double, Quiet>;

} // namespace

double normal_pdf(double z) { return std::exp(-0.5 * z * z) * 0.3989422804014326779; }

double normal_cdf(double z) { return 0.5 * std::erfc(-z * (0.5 * std::numbers::sqrt2)); }

double log_normal_cdf(double z)
{
    if (z > 5) return std::log1p(-normal_cdf(-z));
    if (!(z < -30)) return std::log(normal_cdf(z));
    double const s = 1 / (z * z);
    return -0.5 * z * z - std::log(-z) - kLogRootTwoPi + std::log1p(-s * (1 - s * (3 - s * (15 - s * 105))));
}

double normal_quantile(double p)
{
    return std::isnan(p) ? p : -std::numbers::sqrt2 * boost::math::erfc_inv(2 * p, Quiet());
}

double owens_t(double h, double a) { return boost::math::owens_t(h, a, Quiet()); }

double inverse_logit(double x) { return 1 / (1 + std::exp(-x)); }

double log_choose(double n, double k) { return std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1); }

double chi_square_tail(double x, double degrees_of_freedom)
{
    if (std::isnan(x) || !(degrees_of_freedom >= 0)) return kNaN;
    if (x <= 0) return 1;
    if (degrees_of_freedom == 0 || std::isinf(x)) return 0;
    return boost::math::gamma_q(degrees_of_freedom / 2, x / 2, Quiet());
}

double chi_square_quantile(double p, double degrees_of_freedom)
{
    return 2 * boost::math::gamma_p_inv(degrees_of_freedom / 2, p, Quiet());
}

double student_cdf(double t, double degrees_of_freedom)
{
    return boost::math::cdf(Student(degrees_of_freedom), t);
}

double student_quantile(double p, double degrees_of_freedom)
{
    return boost::math::quantile(Student(degrees_of_freedom), p);
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
