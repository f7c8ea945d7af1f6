#include "study/stats/profile.h"

#include "study/numeric/special.h"

namespace study {

double profile_limit(double confidence, double n, double ratio)
{
    double const z = normal_quantile((1 + confidence) / 2);
    if (!(n > 1)) return z * z;
    double const t = student_quantile((1 + confidence) / 2, n - 1), square = t * t / (n - 1);
    if (ratio >= 1) return n * std::log1p(ratio * square);
    // The variance between observers stays 0 until the mean is so far off that they seem to differ.
    double const there = ratio * (1 + square);
    return there <= 1 ? n * ratio * square : n * (std::log(there) + 1 - ratio);
}

double deviation_limit(double n, double tail)
{
    double const ratio = n / chi_square_quantile(tail, n - 1); // variance at the end by the estimate
    return n * (std::log(ratio) + 1 / ratio - 1);
}

double profile_p(double loss, double n, double ratio)
{
    if (!(n > 1)) return chi_square_tail(loss, 1);
    double square = std::expm1(loss / n) / ratio;
    if (ratio < 1) {
        square = loss / (n * ratio);
        if (ratio * (1 + square) > 1) square = std::exp(loss / n - 1 + ratio) / ratio - 1;
    }
    return 2 * student_cdf(-std::sqrt(square * (n - 1)), n - 1);
}

double moderated(double ratio, double n, double surprises, double trials)
{
    // The kurtosis of a binomial count makes the variance of its squared deviation larger by this, of 2.
    double const kurtosis = std::max(0.0, (1 - 6 * surprises / trials) / surprises);
    double const freedom = n * 2 / (2 + kurtosis) - 1;
    constexpr double kPrior = 1; // degrees of freedom of the likelihood's variance
    double const share = std::min(freedom, n - 1) / (n - 1 + kPrior);
    return share > 0 ? share * ratio + 1 - share : 1;
}

} // namespace study
