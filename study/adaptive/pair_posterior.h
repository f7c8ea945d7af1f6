#pragma once
// Posterior of the scores of items after answers about pairs of them: Thurstone's model with
// P(first is chosen) = Phi(s_first - s_second), and independent normal priors with mean 0.

#include "study/numeric/matrix.h"

#include <map>
#include <utility>
#include <vector>

namespace study {

/// An answer about a pair of items. first_wins  1: the first was chosen, 0: the second, 1/2: neither
struct PairAnswer {
    std::pair<int, int> pair;
    double first_wins = 0;
};

/// Mean and covariance of the posterior, kept up to date with each answer by expectation propagation (Minka 2001,
/// "Expectation Propagation for approximate Bayesian inference", UAI): the answers about a pair are replaced by a
/// normal factor of its difference, so that its mean and variance are exact with all other factors as they are.
/// Where nearly all answers agree, the posterior is skewed, and the approximation at its mode misses both.
class RunningPairPosterior {
public:
    /// @param prior_sd  of scores, in units of F
    RunningPairPosterior(int items, double prior_sd);

    /// Only the factor of this pair is fitted, in O(items^2).
    void add(PairAnswer const& answer);
    /// Fits all factors again until they agree with each other, at most `sweeps` times.
    void refine(int sweeps = 8);

    /// In units of F.
    std::vector<double> const& mean() const { return mean_; }
    Matrix const& covariance() const { return covariance_; }

private:
    struct Factor {
        double first_wins = 0, second_wins = 0;
        double precision = 0, shift = 0; ///< log = -precision d^2 / 2 + shift d
    };
    double fit(std::pair<int, int> pair, Factor& factor);
    void multiply();

    double prior_precision_;
    std::map<std::pair<int, int>, Factor> factors_; ///< by pair, lower item first
    std::vector<double> mean_;
    Matrix covariance_;
};

/// Variance of the difference of two items.
inline double difference_variance(Matrix const& c, std::pair<int, int> pair)
{
    auto const a = std::size_t(pair.first), b = std::size_t(pair.second);
    double const v = c(a, a) + c(b, b) - 2 * c(a, b);
    return v > 0 ? v : 0;
}

/// C - factor c c^T, c = the covariances of the pair's difference: the covariance after more is known of it.
void shrink_along(Matrix& covariance, std::pair<int, int> pair, double factor);

} // namespace study
