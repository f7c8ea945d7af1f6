#include "study/stats/observer_scale.h"

#include "study/stats/bootstrap.h"
#include "study/stats/error.h"
#include "study/stats/pair_likelihood.h"
#include "study/stats/special.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace study {
namespace {

Eigen::MatrixXd dense(Matrix const& m)
{
    return Eigen::MatrixXd::NullaryExpr(
        Eigen::Index(m.rows), Eigen::Index(m.columns),
        [&](Eigen::Index r, Eigen::Index c) { return m(std::size_t(r), std::size_t(c)); });
}

/// A symmetric matrix to a power; eigenvalues below `least` are raised to it.
Eigen::MatrixXd power(Eigen::MatrixXd const& a, double exponent, double least)
{
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> const solved(a);
    Eigen::VectorXd const d = solved.eigenvalues().array().max(least).pow(exponent);
    return solved.eigenvectors() * d.asDiagonal() * solved.eigenvectors().transpose();
}

/// The possible answers to each pair. @param influence  scores by gradients
std::vector<std::vector<PairOutcome>> outcomes_of(std::vector<PairCount> const& pairs, PairModel model,
                                                  PairParameters const& layout, std::span<double const> at,
                                                  Eigen::MatrixXd const& influence)
{
    std::vector<std::vector<PairOutcome>> all;
    for (PairCount const& p : pairs) {
        std::vector<PairCount> answers{{p.first, p.second, 1, 0, 0}, {p.first, p.second, 0, 1, 0}};
        if (layout.has_threshold) answers.push_back({p.first, p.second, 0, 0, 1});
        std::vector<PairOutcome> outcomes;
        for (PairCount const& one : answers) {
            Likelihood l;
            l.clear(layout.count());
            add_pair(model, layout, one, at, l);
            Eigen::VectorXd const moved =
                influence * Eigen::VectorXd::Map(l.gradient.data(), Eigen::Index(layout.count()));
            outcomes.push_back({p.first_wins + p.second_wins + p.ties,
                                std::exp(l.log_likelihood),
                                {moved.data(), moved.data() + moved.size()}});
        }
        all.push_back(std::move(outcomes));
    }
    return all;
}

Matrix kept(Eigen::MatrixXd const& m)
{
    Matrix out(std::size_t(m.rows()), std::size_t(m.cols()));
    for (Eigen::Index r = 0; r < m.rows(); ++r)
        for (Eigen::Index c = 0; c < m.cols(); ++c) out(std::size_t(r), std::size_t(c)) = m(r, c);
    return out;
}

/// How observers differ, as covariance of their own parameters: items one by one, and units.
/// @param at  parameters; the first `scores` of them are scores relative to the first item
Eigen::MatrixXd observers_covariance(std::vector<Eigen::VectorXd> const& gradient,
                                     std::vector<Eigen::MatrixXd> const& information, Eigen::VectorXd const& at,
                                     Eigen::Index scores)
{
    Eigen::Index const n = at.size();
    std::array<Eigen::MatrixXd, 2> parts{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
    parts[0].topLeftCorner(scores, scores) =
        Eigen::MatrixXd::Identity(scores, scores) + Eigen::MatrixXd::Ones(scores, scores);
    parts[1].topLeftCorner(scores, scores) = at.head(scores) * at.head(scores).transpose();
    Eigen::Matrix2d expected = Eigen::Matrix2d::Zero();
    Eigen::Vector2d excess = Eigen::Vector2d::Zero();
    for (std::size_t o = 0; o < gradient.size(); ++o) {
        std::array<Eigen::MatrixXd, 2> const moved{information[o] * parts[0], information[o] * parts[1]};
        for (int k = 0; k < 2; ++k) {
            excess[k] += gradient[o].dot(parts[k] * gradient[o]) - moved[k].trace();
            for (int l = 0; l < 2; ++l) expected(k, l) += (moved[k] * moved[l]).trace();
        }
    }
    // Of two items, or of equal ones, units are no other differences than those of items.
    Eigen::Vector2d const share = expected.completeOrthogonalDecomposition().solve(excess);
    return share[0] * parts[0] + share[1] * parts[1];
}

double weighted(std::span<double const> weights, std::vector<double> const& values)
{
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * values[i];
    return sum;
}

double weighted_variance(std::span<double const> weights, Matrix const& covariance)
{
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i)
        for (std::size_t j = 0; j < weights.size(); ++j) sum += weights[i] * weights[j] * covariance(i, j);
    return sum;
}

/// Sum over trials of the fourth cumulant of their contributions.
double fourth_cumulant(std::vector<std::vector<PairOutcome>> const& pairs, std::span<double const> weights)
{
    double sum = 0;
    for (auto const& outcomes : pairs) {
        double second = 0, fourth = 0;
        for (PairOutcome const& o : outcomes) {
            double const square = std::pow(weighted(weights, o.influence), 2);
            second += o.probability * square;
            fourth += o.probability * square * square;
        }
        sum += outcomes.front().trials * (fourth - 3 * second * second);
    }
    return sum;
}

} // namespace

ObserverScale scale_observers(std::vector<std::vector<PairCount>> const& observers, int items,
                              PairSettings const& settings)
{
    if (observers.size() < 2)
        refuse("errors over " + std::to_string(observers.size()) + " observers",
               "their variation cannot be estimated from fewer than two", "report the standard error of the fit");
    std::vector<PairCount> const pooled = pool(observers);
    ObserverScale s;
    s.observers = int(observers.size());
    s.fit = fit_pairs(pooled, items, settings);
    PairSettings always = settings;
    always.regularisation = Regularisation::always;
    s.reduced = s.fit.regularised ? s.fit : fit_pairs(pooled, items, always);

    PairParameters const layout{items, s.reduced.order.has_value(), s.reduced.tie_threshold.has_value()};
    std::vector<double> at;
    for (std::size_t i = 1; i < s.reduced.score.size(); ++i) at.push_back(s.reduced.score[i] - s.reduced.score[0]);
    if (layout.has_order) at.push_back(s.reduced.order->value);
    if (layout.has_threshold) at.push_back(s.reduced.tie_threshold->value);

    auto const n = Eigen::Index(layout.count());
    std::vector<Eigen::VectorXd> gradient;
    std::vector<Eigen::MatrixXd> information;
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
    for (auto const& pairs : observers) {
        Likelihood l;
        l.clear(layout.count());
        for (PairCount const& p : pairs) add_pair(settings.model, layout, p, at, l);
        gradient.push_back(Eigen::VectorXd::Map(l.gradient.data(), n));
        information.push_back(dense(l.information));
        all += information.back();
    }
    // Scores with mean 0 from parameters that are relative to the first item.
    Eigen::MatrixXd centre = Eigen::MatrixXd::Zero(items, n);
    for (Eigen::Index i = 0; i < items; ++i)
        for (Eigen::Index k = 0; k + 1 < items; ++k) centre(i, k) = (i == k + 1 ? 1.0 : 0.0) - 1.0 / items;

    double const least = n > 0 ? 1e-12 * std::max(1e-300, all.diagonal().cwiseAbs().maxCoeff()) : 0;
    Eigen::MatrixXd const root = n > 0 ? power(all, -0.5, least) : all;
    double squares = 0;
    for (std::size_t o = 0; o < observers.size(); ++o) {
        Eigen::MatrixXd const leverage = root * information[o] * root;
        // An observer who alone determines a score leaves no residual of it: the correction is bounded.
        Eigen::MatrixXd const lifted =
            n > 0 ? power(Eigen::MatrixXd::Identity(n, n) - leverage, -0.5, 0.05) : leverage;
        Eigen::VectorXd const standard = lifted * (root * gradient[o]), moved = centre * (root * standard);
        gradient[o] = all * root * standard;
        squares += standard.squaredNorm();
        s.influence.emplace_back(moved.data(), moved.data() + moved.size());
        s.expected.push_back(kept(centre * root * leverage * root * centre.transpose()));
    }
    s.dispersion = n > 0 ? std::max(0.5, squares / double(n)) : 1;
    Eigen::MatrixXd const own =
        observers_covariance(gradient, information, Eigen::VectorXd::Map(at.data(), n), items - 1);
    Eigen::MatrixXd variances = all;
    for (Eigen::MatrixXd const& i : information) variances += i * own * i;
    Eigen::MatrixXd const to_scores = centre * root * root;
    s.modelled = kept(to_scores * variances * to_scores.transpose());
    s.outcomes = outcomes_of(pooled, settings.model, layout, at, to_scores);
    return s;
}

Contrast contrast(ObserverScale const& s, std::span<double const> weights, double confidence)
{
    if (weights.size() != s.fit.score.size())
        refuse(std::to_string(weights.size()) + " weights",
               "the scale has " + std::to_string(s.fit.score.size()) + " items", "give one weight per item");
    Contrast c;
    c.value = weighted(weights, s.fit.score);
    c.reduced = weighted(weights, s.reduced.score);
    double over_observers = 0, model = 0, squares = 0;
    for (std::size_t o = 0; o < s.influence.size(); ++o) {
        over_observers += std::pow(weighted(weights, s.influence[o]), 2);
        double const expected = weighted_variance(weights, s.expected[o]);
        model += expected;
        squares += expected * expected;
    }
    if (!(model > 0)) return c;
    // The variance of the variance: 2 s^4 and the fourth cumulant for each observer.
    double const noise = squares + fourth_cumulant(s.outcomes, weights) / 2;
    double const d = std::max(1.0, model * model / std::max(noise, 1e-12 * model * model) - 1);
    double const d0 = 2 * double(weights.size() - 1);
    c.degrees_of_freedom = d + d0;
    double const modelled = std::max(weighted_variance(weights, s.modelled), 0.5 * model);
    c.standard_error = std::sqrt((d * over_observers + d0 * modelled) / (d + d0));
    double const half = student_quantile((1 + confidence) / 2, c.degrees_of_freedom) * c.standard_error;
    c.interval = {c.reduced - half, c.reduced + half};
    if (c.standard_error > 0) c.p = 2 * student_cdf(-std::abs(c.reduced) / c.standard_error, c.degrees_of_freedom);
    return c;
}

Contrast score_of(ObserverScale const& s, int item, double confidence)
{
    std::vector<double> w(s.fit.score.size(), 0);
    w.at(std::size_t(item)) = 1;
    return contrast(s, w, confidence);
}

Contrast difference_of(ObserverScale const& s, int a, int b, double confidence)
{
    std::vector<double> w(s.fit.score.size(), 0);
    w.at(std::size_t(a)) += 1;
    w.at(std::size_t(b)) -= 1;
    return contrast(s, w, confidence);
}

} // namespace study
