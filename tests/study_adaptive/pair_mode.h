#pragma once
// The posterior of pair_posterior.h at its mode: what its running mean and covariance are compared with.

#include "study/adaptive/pair_posterior.h"
#include "study/numeric/special.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace study {

/// Normal approximation of the posterior of the scores at its mode, in units of F; the prior makes their mean 0.
struct PairPosterior {
    std::vector<double> mode;
    Matrix covariance;
};

/// By Newton's method; the posterior is log-concave. @param start  of the search, such as an earlier mode; empty = all 0
inline PairPosterior pair_posterior(int items, std::span<PairAnswer const> answers, double prior_sd,
                                    std::vector<double> const& start = {})
{
    Eigen::Index const n = items;
    Eigen::VectorXd s = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n && !start.empty(); ++i) s[i] = start[std::size_t(i)];
    double const prior = 1 / (prior_sd * prior_sd);
    Eigen::MatrixXd information;
    for (int iteration = 0; iteration < 50; ++iteration) {
        Eigen::VectorXd gradient = -prior * s;
        information = Eigen::MatrixXd::Identity(n, n) * prior;
        for (PairAnswer const& answer : answers) {
            auto const [a, b] = answer.pair;
            double const d = s[a] - s[b];
            // A tie is half a win of each.
            for (auto const& [sign, share] : {std::pair{1.0, answer.first_wins}, {-1.0, 1 - answer.first_wins}}) {
                if (share <= 0) continue;
                double const z = sign * d,
                             ratio = std::exp(-z * z / 2 - log_normal_cdf(z)) / std::sqrt(2 * std::numbers::pi);
                double const pull = share * sign * ratio, weight = share * ratio * (z + ratio);
                gradient[a] += pull;
                gradient[b] -= pull;
                information(a, a) += weight;
                information(b, b) += weight;
                information(a, b) -= weight;
                information(b, a) -= weight;
            }
        }
        Eigen::VectorXd const step = information.llt().solve(gradient);
        double const longest = step.cwiseAbs().maxCoeff();
        s += step * std::min(1.0, 2 / std::max(longest, 1e-300));
        if (longest < 1e-10) break;
    }
    Eigen::MatrixXd const inverse = information.llt().solve(Eigen::MatrixXd::Identity(n, n));
    PairPosterior out{{s.data(), s.data() + n}, Matrix(std::size_t(n), std::size_t(n))};
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j) out.covariance(std::size_t(i), std::size_t(j)) = inverse(i, j);
    return out;
}

} // namespace study
