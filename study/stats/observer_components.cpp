#include "study/stats/observer_components.h"

#include <Eigen/Dense>
#include <algorithm>

namespace study {
namespace {

/// Score statistics g^T part_k g, summed over observers: their covariances with each other, with squares of
/// gradients and with gradients.
struct Scatter {
    Eigen::Matrix2d each = Eigen::Matrix2d::Zero();
    std::array<Eigen::MatrixXd, 2> with_squares;
    std::array<Eigen::VectorXd, 2> with_gradient;
};

/// Of normal gradients, and what the cumulants of single answers add.
Scatter scatter_of(std::array<Eigen::MatrixXd, 2> const& part, std::vector<Eigen::MatrixXd> const& observer,
                   std::vector<PairAnswers> const& answers)
{
    Eigen::Index const n = part[0].rows();
    Scatter s;
    s.with_squares.fill(Eigen::MatrixXd::Zero(n, n));
    s.with_gradient.fill(Eigen::VectorXd::Zero(n));
    auto const add_normal = [&](Eigen::MatrixXd const& covariance, double weight) {
        std::array<Eigen::MatrixXd, 2> const moved{covariance * part[0], covariance * part[1]};
        for (std::size_t k = 0; k < 2; ++k) {
            s.with_squares[k] += weight * moved[k] * covariance;
            for (std::size_t l = 0; l < 2; ++l)
                s.each(Eigen::Index(k), Eigen::Index(l)) += weight * (moved[k] * moved[l]).trace();
        }
    };
    for (Eigen::MatrixXd const& covariance : observer) add_normal(covariance, 2);
    for (PairAnswers const& a : answers) {
        Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
        Eigen::Vector2d mean = Eigen::Vector2d::Zero();
        for (std::size_t j = 0; j < a.gradient.size(); ++j) {
            Eigen::VectorXd const& x = a.gradient[j];
            Eigen::Vector2d const squares(x.dot(part[0] * x), x.dot(part[1] * x));
            double const p = a.trials * a.probability[j];
            covariance += a.probability[j] * x * x.transpose();
            mean += a.probability[j] * squares;
            s.each += p * squares * squares.transpose();
            for (std::size_t k = 0; k < 2; ++k) {
                s.with_squares[k] += p * squares[Eigen::Index(k)] * x * x.transpose();
                s.with_gradient[k] += p * squares[Eigen::Index(k)] * x;
            }
        }
        s.each -= a.trials * mean * mean.transpose();
        for (std::size_t k = 0; k < 2; ++k) s.with_squares[k] -= a.trials * mean[Eigen::Index(k)] * covariance;
        add_normal(covariance, -2 * a.trials); // the cumulant is what normal answers do not have
    }
    return s;
}

} // namespace

ObserverComponents observer_components(std::vector<Eigen::VectorXd> const& gradient,
                                       std::vector<Eigen::MatrixXd> const& information, Eigen::VectorXd const& at,
                                       Eigen::Index scores, std::vector<PairAnswers> const& answers)
{
    Eigen::Index const n = at.size();
    ObserverComponents c;
    c.part.fill(Eigen::MatrixXd::Zero(n, n));
    c.part[0].topLeftCorner(scores, scores) =
        Eigen::MatrixXd::Identity(scores, scores) + Eigen::MatrixXd::Ones(scores, scores);
    c.part[1].topLeftCorner(scores, scores) = at.head(scores) * at.head(scores).transpose();
    Eigen::Matrix2d expected = Eigen::Matrix2d::Zero();
    Eigen::Vector2d excess = Eigen::Vector2d::Zero();
    for (std::size_t o = 0; o < gradient.size(); ++o) {
        std::array<Eigen::MatrixXd, 2> const moved{information[o] * c.part[0], information[o] * c.part[1]};
        for (std::size_t k = 0; k < 2; ++k) {
            excess[Eigen::Index(k)] += gradient[o].dot(c.part[k] * gradient[o]) - moved[k].trace();
            for (std::size_t l = 0; l < 2; ++l)
                expected(Eigen::Index(k), Eigen::Index(l)) += (moved[k] * moved[l]).trace();
        }
    }
    // Of two items, or of equal ones, units are no other differences than those of items.
    Eigen::Matrix2d const solved = expected.completeOrthogonalDecomposition().pseudoInverse();
    c.value = solved * excess;
    Eigen::MatrixXd const own = std::max(0.0, c.value[0]) * c.part[0] + std::max(0.0, c.value[1]) * c.part[1];
    for (Eigen::MatrixXd const& i : information) c.observer.push_back(i + i * own * i);
    Scatter const s = scatter_of(c.part, c.observer, answers);
    c.covariance = solved * s.each * solved;
    for (int k = 0; k < 2; ++k) {
        c.with_squares[std::size_t(k)] = solved(k, 0) * s.with_squares[0] + solved(k, 1) * s.with_squares[1];
        c.with_gradient[std::size_t(k)] = solved(k, 0) * s.with_gradient[0] + solved(k, 1) * s.with_gradient[1];
    }
    return c;
}

} // namespace study
