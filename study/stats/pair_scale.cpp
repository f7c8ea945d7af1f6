#include "study/stats/pair_scale.h"

#include "study/numeric/error.h"
#include "study/numeric/special.h"
#include "study/stats/pair_likelihood.h"
#include "study/stats/scores.h"

#include <algorithm>
#include <cmath>

namespace study {
namespace {

double x_log_x_over(double x, double n) { return x == 0 ? 0 : x * std::log(x / n); }

/// Log-likelihood of one free proportion per pair, and the number of these.
double saturated(PairParameters const& layout, std::span<PairCount const> pairs, int& free, double& constant)
{
    double sum = 0;
    for (PairCount const& pair : pairs) {
        double const half = layout.has_threshold ? 0 : pair.ties / 2, ties = layout.has_threshold ? pair.ties : 0;
        double const a = pair.first_wins + half, b = pair.second_wins + half, n = a + b + ties;
        if (n == 0) continue;
        free += layout.has_threshold ? 2 : 1;
        sum += x_log_x_over(a, n) + x_log_x_over(b, n) + x_log_x_over(ties, n);
        constant += std::lgamma(n + 1) - std::lgamma(a + 1) - std::lgamma(b + 1) - std::lgamma(ties + 1);
    }
    return sum;
}

} // namespace

void check_connected(Matrix const& wins, std::vector<std::string> const& names)
{
    auto const name = [&](std::size_t i) {
        return names.empty() ? "item " + std::to_string(i) : "item '" + names[i] + "'";
    };
    std::vector<int> const part = connected_parts(wins);
    for (std::size_t i = 0; i < part.size(); ++i)
        if (part[i] != 0)
            refuse(name(i) + " is not connected with " + name(0) + " by any chain of comparisons",
                   "the distance between such items is unknown",
                   "scale the connected items separately, or add comparisons between them");
}

PairScale fit_pairs(std::span<PairCount const> pairs, int items, PairSettings const& settings)
{
    Matrix const wins = wins_of(pairs, items);
    check_connected(wins);
    bool any_ties = false, any_wins = false;
    for (PairCount const& p : pairs) {
        any_ties = any_ties || p.ties > 0;
        any_wins = any_wins || p.first_wins + p.second_wins > 0;
    }
    bool const threshold = settings.ties == TieModel::threshold && any_ties;
    if (threshold && !any_wins)
        refuse("nothing but ties", "the threshold of ties is infinite", "count ties as half wins");

    PairParameters const layout{items, settings.order == OrderEffect::fitted && !pairs.empty(), threshold};
    LikelihoodAt const model = [&](std::span<double const> at, Likelihood& l) {
        l.clear(layout.count());
        for (PairCount const& p : pairs) add_pair(settings.model, layout, p, at, l);
    };
    std::vector<double> start(layout.count(), 0);
    std::vector<Bound> bounds;
    if (threshold) {
        start.back() = 0.3;
        bounds.assign(layout.count(), {});
        bounds.back().low = kLeastTieThreshold;
    }

    PairScale scale;
    scale.model = settings.model;
    MaximumLikelihood fit;
    bool const finite = each_beats_each(wins);
    if (settings.regularisation != Regularisation::always && finite) fit = maximise(model, start, bounds);
    bool const off = !finite || runs_off(fit);
    if (off && settings.regularisation == Regularisation::never)
        refuse("some items won or lost all of their comparisons", "their maximum-likelihood scores are infinite",
               "use the regularised estimate, or collect more trials");
    if (off || settings.regularisation == Regularisation::always) {
        scale.regularised = true;
        scale.note = off ? "some choices were unanimous, so that maximum likelihood would be infinite: "
                           "regularised by Jeffreys' prior"
                         : "regularised by Jeffreys' prior, as asked for";
        fit = maximise(with_jeffreys_prior(model), start, bounds);
    }
    if (!fit.converged) scale.note += std::string(scale.note.empty() ? "" : "; ") + "the fit did not converge";
    if (settings.ties == TieModel::threshold && !any_ties)
        scale.note += std::string(scale.note.empty() ? "" : "; ") + "no ties: their threshold is 0";

    Scores centred_scores = centred(fit, std::size_t(items));
    scale.score = std::move(centred_scores.score);
    scale.standard_error = std::move(centred_scores.standard_error);
    scale.covariance = std::move(centred_scores.covariance);
    auto const estimate = [&](std::size_t i) {
        return Estimate{fit.estimate[i], std::sqrt(std::max(0.0, fit.covariance(i, i)))};
    };
    if (layout.has_order) scale.order = estimate(layout.order_at());
    if (threshold) scale.tie_threshold = estimate(layout.threshold_at());

    Likelihood at_fit;
    model(fit.estimate, at_fit);
    int free = 0;
    double constant = 0;
    double const best = saturated(layout, pairs, free, constant);
    scale.log_likelihood = at_fit.log_likelihood + constant;
    scale.deviance = std::max(0.0, 2 * (best - at_fit.log_likelihood));
    scale.degrees_of_freedom = free - int(layout.count());
    if (scale.degrees_of_freedom > 0) scale.fit_p = chi_square_tail(scale.deviance, scale.degrees_of_freedom);
    return scale;
}

double jod_per_unit(PairModel model)
{
    return model == PairModel::thurstone_v ? 1 / normal_quantile(0.75) : 1 / std::log(3.0);
}

Difference difference(PairScale const& scale, int a, int b)
{
    int const n = int(scale.score.size());
    if (a < 0 || b < 0 || a >= n || b >= n)
        refuse("items " + std::to_string(a) + " and " + std::to_string(b),
               "the scale has items 0 to " + std::to_string(n - 1), "check the item numbers");
    auto const i = std::size_t(a), j = std::size_t(b);
    Matrix const& c = scale.covariance;
    Difference d{scale.score[i] - scale.score[j], std::sqrt(std::max(0.0, c(i, i) + c(j, j) - 2 * c(i, j))), 1};
    if (d.standard_error > 0) d.p = 2 * normal_cdf(-std::abs(d.value) / d.standard_error);
    return d;
}

} // namespace study
