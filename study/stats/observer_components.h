#pragma once
// How observers of pairs differ, as variance components: see observer_scale.h. All is in the space of the
// parameters' gradients; q stands for a direction of it.

#include <Eigen/Core>
#include <array>
#include <vector>

namespace study {

/// The possible answers to a pair: their probabilities, and gradients of the log-likelihood.
struct PairAnswers {
    double trials = 0;
    std::vector<double> probability;
    std::vector<Eigen::VectorXd> gradient;
};

struct ObserverComponents {
    std::array<Eigen::MatrixXd, 2> part; ///< covariance of observers' parameters by one unit of each component
    Eigen::Vector2d value;               ///< may be below 0
    Eigen::Matrix2d covariance;          ///< of the values
    /// q^T (...) q: covariance of a value with the sum over observers of (q^T gradient)^2.
    std::array<Eigen::MatrixXd, 2> with_squares;
    std::array<Eigen::VectorXd, 2> with_gradient; ///< covariance of a value with the sum of gradients
    std::vector<Eigen::MatrixXd> observer;        ///< covariance of each one's gradient; no component below 0
};

/// @param gradient     of each observer
/// @param information  of each observer's independent trials
/// @param at           parameters; the first `scores` of them are scores relative to the first item
ObserverComponents observer_components(std::vector<Eigen::VectorXd> const& gradient,
                                       std::vector<Eigen::MatrixXd> const& information, Eigen::VectorXd const& at,
                                       Eigen::Index scores, std::vector<PairAnswers> const& answers);

} // namespace study
