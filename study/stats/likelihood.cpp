#include "study/stats/likelihood.h"

#include <algorithm>
#include <cmath>

namespace study {
namespace {

constexpr double kConverged = 1e-13; ///< threshold on the predicted gain in log-likelihood of a step

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

Matrix among(Matrix const& all, std::vector<std::size_t> const& chosen)
{
    Matrix part(chosen.size(), chosen.size());
    for (std::size_t r = 0; r < chosen.size(); ++r)
        for (std::size_t c = 0; c < chosen.size(); ++c) part(r, c) = all(chosen[r], chosen[c]);
    return part;
}

/// Step of the free parameters, with damping increased until the information is positive definite.
std::vector<double> damped_step(Matrix const& information, std::vector<double> const& gradient, double& damping)
{
    for (;; damping = std::max(1e-6, damping * 10)) {
        Matrix damped = information;
        for (std::size_t i = 0; i < damped.rows; ++i)
            damped(i, i) += damping * (information(i, i) > 0 ? information(i, i) : 1);
        if (auto const factor = cholesky(damped)) return solve(*factor, gradient);
        if (!(damping < 1e12)) return std::vector<double>(gradient.size(), 0);
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
    auto const part = inverse(among(information, inside));
    for (std::size_t r = 0; r < inside.size(); ++r)
        for (std::size_t c = 0; c < inside.size(); ++c)
            result.covariance(inside[r], inside[c]) = part ? (*part)(r, c) : std::nan("");
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
    double damping = 0;
    for (int iteration = 0; iteration < max_iterations && !result.converged; ++iteration) {
        auto const free = free_parameters(x, bounds, here.gradient);
        std::vector<double> gradient;
        for (std::size_t const i : free) gradient.push_back(here.gradient[i]);
        std::vector<double> const step = damped_step(among(here.information, free), gradient, damping);

        std::vector<double> next = x;
        double gain = 0;
        for (std::size_t k = 0; k < free.size(); ++k) {
            double& v = next[free[k]];
            v += step[k];
            if (!bounds.empty()) v = std::clamp(v, bounds[free[k]].low, bounds[free[k]].high);
            gain += gradient[k] * (v - x[free[k]]);
        }
        model(next, there);
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
    result.log_likelihood = here.log_likelihood;
    set_covariance(result, here.information, bounds);
    return result;
}

LikelihoodAt with_jeffreys_prior(LikelihoodAt model)
{
    auto const half_log_determinant = [](Likelihood const& l) {
        auto const factor = cholesky(l.information);
        if (!factor) return -std::numeric_limits<double>::infinity();
        double sum = 0;
        for (std::size_t i = 0; i < factor->rows; ++i) sum += std::log((*factor)(i, i));
        return sum;
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
