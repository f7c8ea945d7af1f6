#include "study/adaptive/pair_posterior.h"

#include "study/numeric/special.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace study {
namespace {

Eigen::Map<Eigen::MatrixXd> as_symmetric(Matrix& m)
{
    return {m.values.data(), Eigen::Index(m.rows), Eigen::Index(m.columns)}; // symmetric: row-major is the same
}

struct Moments {
    double mean, variance;
};

/// Of the density N(d; mean, variance) Phi(d)^first_wins Phi(-d)^second_wins by the trapezoidal rule, which
/// converges fast for smooth functions. @param near  about where its mass is
Moments moments(Moments const& normal, double first_wins, double second_wins, Moments const& near)
{
    constexpr int kSteps = 24;
    constexpr double kWidest = 5.75; // deviations of `near`, which is rarely narrower
    std::array<double, 2 * kSteps + 1> log_density;
    double const deviation = std::sqrt(near.variance);
    auto const at = [&](int i) { return near.mean + kWidest * deviation * i / kSteps; };
    double most = -1e308;
    for (int i = -kSteps; i <= kSteps; ++i) {
        double const d = at(i), z = d - normal.mean;
        double value = -z * z / (2 * normal.variance);
        if (first_wins > 0) value += first_wins * log_normal_cdf(d);
        if (second_wins > 0) value += second_wins * log_normal_cdf(-d);
        log_density[std::size_t(i + kSteps)] = value;
        most = std::max(most, value);
    }
    double sum = 0, first = 0, second = 0;
    for (int i = -kSteps; i <= kSteps; ++i) {
        double const w = std::exp(log_density[std::size_t(i + kSteps)] - most), d = at(i) - near.mean;
        sum += w;
        first += w * d;
        second += w * d * d;
    }
    double const mean = first / sum;
    return {near.mean + mean, second / sum - mean * mean};
}

} // namespace

RunningPairPosterior::RunningPairPosterior(int items, double prior_sd)
    : prior_precision_(1 / (prior_sd * prior_sd)),
      mean_(std::size_t(items), 0),
      covariance_(std::size_t(items), std::size_t(items))
{
    multiply();
}

void RunningPairPosterior::add(PairAnswer const& answer)
{
    auto [a, b] = answer.pair;
    double wins = answer.first_wins;
    if (a > b) {
        std::swap(a, b);
        wins = 1 - wins;
    }
    Factor& factor = factors_[{a, b}];
    factor.first_wins += wins;
    factor.second_wins += 1 - wins;
    fit({a, b}, factor);
}

void RunningPairPosterior::refine(int sweeps)
{
    constexpr double kSettled = 1e-3; // units of F
    multiply();
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        double change = 0;
        for (auto& [pair, factor] : factors_) change = std::max(change, fit(pair, factor));
        if (change < kSettled) break;
    }
}

/// @return how far the difference's mean moved
double RunningPairPosterior::fit(std::pair<int, int> pair, Factor& factor)
{
    double const v = difference_variance(covariance_, pair);
    double const m = mean_[std::size_t(pair.first)] - mean_[std::size_t(pair.second)];
    double const rest_precision = 1 / v - factor.precision; // without this factor
    if (!(rest_precision > 1e-9)) return 0;
    Moments const rest{(m / v - factor.shift) / rest_precision, 1 / rest_precision};
    Moments const now = moments(rest, factor.first_wins, factor.second_wins, {m, v});
    if (!(now.variance > 1e-9)) return 0;
    // Phi is log-concave: its factor never widens.
    double const precision = std::max(0.0, 1 / now.variance - rest_precision);
    double const shift = now.mean / now.variance - rest.mean * rest_precision;
    double const dp = precision - factor.precision, ds = shift - factor.shift;
    double const narrowed = dp / (1 + dp * v);
    double const move = ds * (1 - narrowed * v) - narrowed * m;
    for (std::size_t i = 0; i < mean_.size(); ++i)
        mean_[i] += move * (covariance_(i, std::size_t(pair.first)) - covariance_(i, std::size_t(pair.second)));
    shrink_along(covariance_, pair, narrowed);
    factor.precision = precision;
    factor.shift = shift;
    return std::abs(now.mean - m);
}

/// Mean and covariance of the prior times all factors.
void RunningPairPosterior::multiply()
{
    auto const n = Eigen::Index(mean_.size());
    Eigen::MatrixXd information = Eigen::MatrixXd::Identity(n, n) * prior_precision_;
    Eigen::VectorXd shift = Eigen::VectorXd::Zero(n);
    for (auto const& [pair, factor] : factors_) {
        auto const [a, b] = pair;
        information(a, a) += factor.precision;
        information(b, b) += factor.precision;
        information(a, b) -= factor.precision;
        information(b, a) -= factor.precision;
        shift[a] += factor.shift;
        shift[b] -= factor.shift;
    }
    as_symmetric(covariance_) = information.llt().solve(Eigen::MatrixXd::Identity(n, n));
    Eigen::VectorXd::Map(mean_.data(), n) = as_symmetric(covariance_) * shift;
}

void shrink_along(Matrix& covariance, std::pair<int, int> pair, double factor)
{
    auto c = as_symmetric(covariance);
    Eigen::VectorXd const along = c.col(pair.first) - c.col(pair.second);
    c -= factor * along * along.transpose();
}

} // namespace study
