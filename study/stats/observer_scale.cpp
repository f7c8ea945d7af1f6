#include "study/stats/observer_scale.h"

#include "study/numeric/error.h"
#include "study/numeric/special.h"
#include "study/stats/bootstrap.h"
#include "study/stats/observer_components.h"
#include "study/stats/pair_likelihood.h"

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

/// How a scale changes by leaving out one observer's choices (the jackknife: Miller 1974, Biometrika 61:1). Unlike
/// influences, which are derivatives, such changes know that far-off choices weigh more, the farther off: `at` minus the
/// parameters of the fit with Jeffreys' prior to all choices except `own`, which determine them, by three steps
/// from `at`: more would change variances by 3 % at most.
/// @param at  of the fit with Jeffreys' prior to the pooled choices
Eigen::VectorXd change_without(std::span<PairCount const> pooled, std::span<PairCount const> own, PairModel model,
                               PairParameters const& layout, std::span<double const> at)
{
    std::vector<PairCount> others(pooled.begin(), pooled.end());
    for (PairCount const& p : own)
        for (PairCount& o : others) {
            if (o.first != p.first || o.second != p.second) continue;
            o.first_wins = std::max(0.0, o.first_wins - p.first_wins);
            o.second_wins = std::max(0.0, o.second_wins - p.second_wins);
            o.ties = std::max(0.0, o.ties - p.ties);
        }
    LikelihoodAt const penalised = with_jeffreys_prior([&](std::span<double const> x, Likelihood& l) {
        l.clear(layout.count());
        for (PairCount const& p : others) add_pair(model, layout, p, x, l);
    });
    std::vector<Bound> bounds;
    if (layout.has_threshold) {
        bounds.assign(layout.count(), {});
        bounds.back().low = kLeastTieThreshold;
    }
    constexpr int kSteps = 3;
    auto const fit = maximise(penalised, {at.begin(), at.end()}, bounds, kSteps);
    auto const n = Eigen::Index(layout.count());
    return Eigen::VectorXd::Map(at.data(), n) - Eigen::VectorXd::Map(fit.estimate.data(), n);
}

/// The possible answers to each pair.
std::vector<PairAnswers> answers_of(std::vector<PairCount> const& pairs, PairModel model,
                                    PairParameters const& layout, std::span<double const> at)
{
    std::vector<PairAnswers> all;
    for (PairCount const& p : pairs) {
        std::vector<PairCount> answers{{p.first, p.second, 1, 0, 0}, {p.first, p.second, 0, 1, 0}};
        if (layout.has_threshold) answers.push_back({p.first, p.second, 0, 0, 1});
        PairAnswers a;
        a.trials = p.first_wins + p.second_wins + p.ties;
        for (PairCount const& one : answers) {
            Likelihood l;
            l.clear(layout.count());
            add_pair(model, layout, one, at, l);
            a.probability.push_back(std::exp(l.log_likelihood));
            a.gradient.push_back(Eigen::VectorXd::Map(l.gradient.data(), Eigen::Index(layout.count())));
        }
        all.push_back(std::move(a));
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

/// Sums over trials of cumulants of their contributions.
struct Cumulants {
    double third = 0, fourth = 0;
};
Cumulants cumulants(std::vector<std::vector<PairOutcome>> const& pairs, std::span<double const> weights)
{
    Cumulants sum;
    for (auto const& outcomes : pairs) {
        double second = 0, third = 0, fourth = 0;
        for (PairOutcome const& o : outcomes) {
            double const moved = weighted(weights, o.influence), square = moved * moved;
            second += o.probability * square;
            third += o.probability * square * moved;
            fourth += o.probability * square * square;
        }
        sum.third += outcomes.front().trials * third;
        sum.fourth += outcomes.front().trials * (fourth - 3 * second * second);
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
    Eigen::MatrixXd const back = n > 0 ? power(all, 0.5, least) : all;
    double squares = 0;
    for (std::size_t o = 0; o < observers.size(); ++o) {
        Eigen::MatrixXd const leverage = root * information[o] * root;
        // A score that one observer alone determines has no residual, so the correction is limited.
        constexpr double kLeastRest = 0.05;
        Eigen::MatrixXd const rest = Eigen::MatrixXd::Identity(n, n) - leverage;
        Eigen::MatrixXd const lifted = n > 0 ? power(rest, -0.5, kLeastRest) : leverage;
        Eigen::VectorXd const standard = lifted * (root * gradient[o]);
        Eigen::VectorXd moved = centre * (root * standard);
        gradient[o] = all * root * standard;
        squares += standard.squaredNorm();
        s.influence.emplace_back(moved.data(), moved.data() + moved.size());
        if (n > 0 && rest.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() > kLeast) {
            Eigen::VectorXd const change = change_without(pooled, observers[o], settings.model, layout, at);
            moved = centre * (root * (power(rest, 0.5, kLeast) * (back * change)));
        }
        s.left_out.emplace_back(moved.data(), moved.data() + moved.size());
        s.expected.push_back(kept(centre * root * leverage * root * centre.transpose()));
    }
    s.dispersion = n > 0 ? std::max(0.5, squares / double(n)) : 1;
    std::vector<PairAnswers> const answers = answers_of(pooled, settings.model, layout, at);
    ObserverComponents const differ =
        observer_components(gradient, information, Eigen::VectorXd::Map(at.data(), n), items - 1, answers);
    Eigen::MatrixXd const to_scores = centre * root * root;
    auto const of_scores = [&](Eigen::MatrixXd const& m) {
        return Eigen::MatrixXd(to_scores * m * to_scores.transpose());
    };
    Eigen::MatrixXd modelled = of_scores(all);
    for (std::size_t k = 0; k < 2; ++k) {
        Eigen::MatrixXd differences = Eigen::MatrixXd::Zero(n, n);
        for (Eigen::MatrixXd const& i : information) differences += i * differ.part[k] * i;
        modelled += differ.value[Eigen::Index(k)] * of_scores(differences);
        Eigen::VectorXd const with_score = to_scores * differ.with_gradient[k];
        s.components[k] = {kept(of_scores(differences)),
                           kept(of_scores(differ.with_squares[k])),
                           {with_score.data(), with_score.data() + with_score.size()},
                           {differ.covariance(Eigen::Index(k), 0), differ.covariance(Eigen::Index(k), 1)}};
    }
    s.modelled = kept(modelled);
    for (Eigen::MatrixXd const& covariance : differ.observer) s.observer.push_back(kept(of_scores(covariance)));
    for (PairAnswers const& a : answers) {
        std::vector<PairOutcome> outcomes;
        for (std::size_t j = 0; j < a.gradient.size(); ++j) {
            Eigen::VectorXd const moved = to_scores * a.gradient[j];
            outcomes.push_back({a.trials, a.probability[j], {moved.data(), moved.data() + moved.size()}});
        }
        s.outcomes.push_back(std::move(outcomes));
    }
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
    double over_observers = 0, left_out = 0, independent = 0, squares = 0, of_sum = 0, scatter = 0;
    for (std::size_t o = 0; o < s.influence.size(); ++o) {
        over_observers += std::pow(weighted(weights, s.influence[o]), 2);
        left_out += std::pow(weighted(weights, s.left_out[o]), 2);
        double const trials = weighted_variance(weights, s.expected[o]);
        independent += trials;
        squares += trials * trials;
        double const modelled = weighted_variance(weights, s.observer[o]);
        of_sum += modelled;
        scatter += 2 * modelled * modelled;
    }
    if (!(independent > 0)) return c;
    // The variance of the variance: 2 s^4 and the fourth cumulant for each observer.
    Cumulants const trials = cumulants(s.outcomes, weights);
    double const noise = squares + trials.fourth / 2, square = independent * independent;
    double const d = std::max(1.0, square / std::max(noise, 1e-12 * square) - 1);
    constexpr double kOfModel = 2;
    double const share = d / (d + kOfModel);
    double const modelled = std::max(weighted_variance(weights, s.modelled), 0.5 * independent);
    double variance = share * over_observers + (1 - share) * modelled;
    double const of_trials = independent / std::max({of_sum, variance, independent});
    variance += (1 - of_trials * of_trials) * std::max(0.0, left_out - over_observers);
    // Satterthwaite's degrees of freedom: the variance of the two together.
    double both = 0, of_model = 0, with_score = share * trials.third;
    std::array<double, 2> const by_unit{weighted_variance(weights, s.components[0].variance),
                                        weighted_variance(weights, s.components[1].variance)};
    for (std::size_t k = 0; k < 2; ++k) {
        both += by_unit[k] * weighted_variance(weights, s.components[k].with_squares);
        with_score += (1 - share) * by_unit[k] * weighted(weights, s.components[k].with_score);
        for (std::size_t l = 0; l < 2; ++l) of_model += by_unit[k] * by_unit[l] * s.components[k].covariance[l];
    }
    scatter = share * share * (scatter + trials.fourth) + 2 * share * (1 - share) * both +
              (1 - share) * (1 - share) * of_model;
    double const own = scatter - with_score * with_score / std::max(of_sum, variance);
    c.degrees_of_freedom = std::max(1.0, 2 * of_sum * of_sum / std::max(own, 0.1 * scatter));
    c.standard_error = std::sqrt(variance);
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
