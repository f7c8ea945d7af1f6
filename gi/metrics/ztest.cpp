#include "gi/metrics/ztest.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gi {

namespace {

/// Spacing of floats, relative: bounds their rounding, which alone is left where all paths see the same.
constexpr double kRounding = std::numeric_limits<float>::epsilon();

/// P(X >= chi2) for n degrees of freedom (Wilson & Hilferty 1931: the cube root of chi2 / n is nearly normal).
double chi_square_tail(double chi2, double n)
{
    double const spread = 2 / (9 * n);
    return 0.5 * std::erfc((std::cbrt(chi2 / n) - (1 - spread)) / std::sqrt(2 * spread));
}

} // namespace

double two_sided_p(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

ZTest z_test(std::vector<float> const& image, std::vector<float> const& variance,
             std::vector<float> const& reference, std::vector<float> const& reference_variance)
{
    ZTest t;
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        double const difference = double(image[i]) - double(reference[i]);
        double const var =
            double(variance[i]) + (reference_variance.empty() ? 0.0 : double(reference_variance[i]));
        if (!std::isfinite(difference) || !std::isfinite(var)) continue;
        double const rounding = kRounding * std::hypot(double(image[i]), double(reference[i]));
        if (!(var > 0) && std::abs(difference) <= rounding) continue;
        double const z = difference / std::sqrt(var + rounding * rounding);
        ++t.count;
        sum += z;
        squares += z * z;
        t.beyond_2 += std::abs(z) > 2;
        t.beyond_3 += std::abs(z) > 3;
        t.largest = std::max(t.largest, std::abs(z));
    }
    if (t.count == 0) return t;
    double const n = double(t.count);
    t.mean_z = sum / n;
    t.beyond_2 /= n;
    t.beyond_3 /= n;
    t.sidak_p = -std::expm1(n * std::log1p(-std::min(two_sided_p(t.largest), 1 - 1e-16)));
    t.chi2_p = chi_square_tail(squares, n);
    t.mean_p = two_sided_p(t.mean_z * std::sqrt(n));
    return t;
}

} // namespace gi
