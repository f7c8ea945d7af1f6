#include "study/stats/likelihood.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

namespace study {
namespace {

constexpr double kConverged = 1e-13; ///< threshold on the predicted gain in log-likelihood of a step
/// The same where the iterations end: estimates are then within 0.015 standard errors of the maximum.
/// Scoring by the expected information gains little per step where it differs from the curvature,
/// as with lapse rates near their bounds.
constexpr double kNearEnough = 1e-4;

/// Free parameters: all except those that the gradient pushes against a bound.
std::vector<std::size_t> free_parameters(std::vector<double> const& x, std::vector<Bound> const& bounds,
                                         std::vector<double> const& gradient)
{
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < x.size(); ++i) {
        bool const stuck = !bounds.empty() && ((x[i] <= bounds[i].low && gradient[i] <= 0) ||
                                               (x[i] >= bounds[i].high && gradient[i] >= 0));
        if (!stuck) free.push_back(i);
    }
    return free;
}

using Factor = Eigen::LLT<Eigen::MatrixXd>;

Eigen::MatrixXd among(Matrix const& all, std::vector<std::size_t> const& chosen)
{
    auto const n = Eigen::Index(chosen.size());
    return Eigen::MatrixXd::NullaryExpr(
        n, n, [&](Eigen::Index r, Eigen::Index c) { return all(chosen[std::size_t(r)], chosen[std::size_t(c)]); });
}

/// Cholesky factor; empty if `a` is not positive definite within rounding.
std::optional<Factor> cholesky(Eigen::MatrixXd const& a)
{
    Factor factor(a);
    bool const is_regular =
        (factor.matrixLLT().diagonal().array().square() > 1e-14 * a.diagonal().array()).all() && a.allFinite();
    return factor.info() == Eigen::Success && is_regular ? std::optional(factor) : std::nullopt;
}

/// Step of the free parameters, with damping increased until the information is positive definite.
Eigen::VectorXd damped_step(Eigen::MatrixXd const& information, Eigen::VectorXd const& gradient, double& damping)
{
    if (gradient.size() == 0) return gradient; // nothing is free
    for (;; damping = std::max(1e-6, damping * 10)) {
        Eigen::MatrixXd damped = information;
        for (double& d : damped.diagonal()) d += damping * (d > 0 ? d : 1);
        if (auto const factor = cholesky(damped)) return factor->solve(gradient);
        if (!(damping < 1e12)) return Eigen::VectorXd::Zero(gradient.size());
    }
}

void set_covariance(MaximumLikelihood& result, Matrix const& information, std::vector<Bound> const& bounds)
{
    std::size_t const n = result.estimate.size();
    std::vector<std::size_t> inside;
    result.at_bound.assign(n, false);
    for (std::size_t i = 0; i < n; ++i) {
        result.at_bound[i] = !bounds.empty() && (result.estimate[i] <= bounds[i].low || //
                                                 result.estimate[i] >= bounds[i].high);
        if (!result.at_bound[i]) inside.push_back(i);
    }
    result.covariance = Matrix(n, n);
    auto const factor = cholesky(among(information, inside));
    auto const m = Eigen::Index(inside.size());
    Eigen::MatrixXd part = Eigen::MatrixXd::Constant(m, m, std::nan(""));
    if (factor) part = factor->solve(Eigen::MatrixXd::Identity(m, m));
    for (Eigen::Index r = 0; r < m; ++r)
        for (Eigen::Index c = 0; c < m; ++c)
            result.covariance(inside[std::size_t(r)], inside[std::size_t(c)]) = part(r, c);
}

} // namespace

void Likelihood::clear(std::size_t n)
{
    log_likelihood = 0;
    gradient.assign(n, 0);
    information.rows = information.columns = n;
    information.values.assign(n * n, 0);
}

MaximumLikelihood maximise(LikelihoodAt const& model, std::vector<double> start, std::vector<Bound> const& bounds,
                           int max_iterations)
{
    MaximumLikelihood result;
    result.estimate = std::move(start);
    std::vector<double>& x = result.estimate;
    Likelihood here, there;
    model(x, here);
    double damping = 0, last_gain = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < max_iterations && !result.converged; ++iteration) {
        auto const free = free_parameters(x, bounds, here.gradient);
        Eigen::VectorXd gradient(Eigen::Index(free.size()));
        for (std::size_t k = 0; k < free.size(); ++k) gradient[Eigen::Index(k)] = here.gradient[free[k]];
        Eigen::VectorXd const step = damped_step(among(here.information, free), gradient, damping);

        std::vector<double> next = x;
        double gain = 0;
        auto const go = [&](double share) {
            gain = 0;
            for (std::size_t k = 0; k < free.size(); ++k) {
                double& v = next[free[k]];
                v = x[free[k]] + share * step[Eigen::Index(k)];
                if (!bounds.empty()) v = std::clamp(v, bounds[free[k]].low, bounds[free[k]].high);
                gain += gradient[Eigen::Index(k)] * (v - x[free[k]]);
            }
            model(next, there);
            return there.log_likelihood >= here.log_likelihood;
        };
        // Where the curvature is above the expected information, whole steps go too far.
        bool const is_better = go(1);
        last_gain = gain * (1 + damping);
        if (!is_better && !go(0.5)) go(0.25);
        if (there.log_likelihood >= here.log_likelihood) {
            x = next;
            std::swap(here, there);
            result.converged = gain < kConverged && damping < 1e-3;
            damping = damping < 1e-9 ? 0 : damping / 10;
        } else {
            // No further gain is possible within rounding.
            result.converged = gain < 1e-11 * (1 + std::abs(here.log_likelihood));
            damping = std::max(1e-4, damping * 10);
            if (damping > 1e14) break;
        }
    }
    result.converged = result.converged || last_gain < kNearEnough;
    result.log_likelihood = here.log_likelihood;
    set_covariance(result, here.information, bounds);
    return result;
}

LikelihoodAt with_jeffreys_prior(LikelihoodAt model)
{
    auto const half_log_determinant = [](Likelihood const& l) {
        auto const n = Eigen::Index(l.information.rows);
        auto const factor = cholesky(Eigen::MatrixXd::Map(l.information.values.data(), n, n)); // symmetric
        return factor ? factor->matrixLLT().diagonal().array().log().sum()
                      : -std::numeric_limits<double>::infinity();
    };
    return [=](std::span<double const> at, Likelihood& l) {
        constexpr double kStep = 1e-4;
        std::vector<double> x(at.begin(), at.end()), slope(at.size());
        for (std::size_t i = 0; i < x.size(); ++i) {
            x[i] = at[i] + kStep;
            model(x, l);
            double const above = half_log_determinant(l);
            x[i] = at[i] - kStep;
            model(x, l);
            slope[i] = (above - half_log_determinant(l)) / (2 * kStep);
            x[i] = at[i];
        }
        model(x, l);
        l.log_likelihood += half_log_determinant(l);
        for (std::size_t i = 0; i < x.size(); ++i) l.gradient[i] += slope[i];
    };
}

} // namespace study
