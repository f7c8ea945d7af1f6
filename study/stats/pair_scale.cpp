#include "study/stats/pair_scale.h"

#include "study/stats/error.h"
#include "study/stats/scores.h"
#include "study/stats/special.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace study {
namespace {

/// F, its density, and log F, accurate in small tails.
struct Link {
    PairModel model;
    double log_cdf(double z) const
    {
        if (model == PairModel::thurstone_v) return log_normal_cdf(z);
        return z > 0 ? -std::log1p(std::exp(-z)) : z - std::log1p(std::exp(z));
    }
    double density(double z) const
    {
        if (model == PairModel::thurstone_v) return normal_pdf(z);
        double const e = std::exp(-std::abs(z));
        return e / ((1 + e) * (1 + e));
    }
};

/// Layout of the parameters: scores of all items except the first, then the other fitted ones.
struct Layout {
    int items;
    bool order, threshold;
    std::size_t order_at() const { return std::size_t(items - 1); }
    std::size_t threshold_at() const { return order_at() + order; }
    std::size_t count() const { return threshold_at() + threshold; }
};

double x_log_y(double x, double log_y) { return x == 0 ? 0 : x * log_y; }
double x_log_x_over(double x, double n) { return x == 0 ? 0 : x * std::log(x / n); }

/// Adds one pair: up to three outcomes with probabilities p and slopes dp by z = d + b and by the threshold.
void add_pair(Link link, Layout const& layout, PairCount const& pair, std::span<double const> at, Likelihood& l)
{
    std::array<std::size_t, 4> index{};
    std::array<double, 4> factor{}; // of z
    std::size_t used = 0;
    double z = 0;
    auto const depend = [&](std::size_t parameter, double by) {
        z += by * at[parameter];
        index[used] = parameter;
        factor[used++] = by;
    };
    if (pair.first > 0) depend(std::size_t(pair.first) - 1, 1);
    if (pair.second > 0) depend(std::size_t(pair.second) - 1, -1);
    if (layout.order) depend(layout.order_at(), 1);
    double const t = layout.threshold ? at[layout.threshold_at()] : 0;
    double const half = layout.threshold ? 0 : pair.ties / 2;
    std::array<double, 3> const count{pair.first_wins + half, pair.second_wins + half,
                                      layout.threshold ? pair.ties : 0};
    double const n = count[0] + count[1] + count[2];

    double const log_p0 = link.log_cdf(z - t), log_p1 = link.log_cdf(-z - t);
    double const f0 = link.density(z - t), f1 = link.density(-z - t);
    double const p2 = layout.threshold ? std::max(1e-300, 1 - std::exp(log_p0) - std::exp(log_p1)) : 1;
    std::array<double, 3> const log_p{log_p0, log_p1, std::log(p2)};
    std::array<double, 3> const by_z{f0, -f1, f1 - f0}, by_t{-f0, -f1, f0 + f1};
    if (layout.threshold) {
        index[used] = layout.threshold_at();
        factor[used++] = 0;
    }
    for (std::size_t o = 0; o < (layout.threshold ? 3u : 2u); ++o) {
        double const p = std::exp(log_p[o]);
        l.log_likelihood += x_log_y(count[o], log_p[o]);
        for (std::size_t a = 0; a < used; ++a) {
            bool const a_is_t = layout.threshold && a + 1 == used;
            double const slope_a = a_is_t ? by_t[o] : by_z[o] * factor[a];
            if (p > 0) l.gradient[index[a]] += count[o] * slope_a / p;
            for (std::size_t b = 0; b < used; ++b) {
                bool const b_is_t = layout.threshold && b + 1 == used;
                double const slope_b = b_is_t ? by_t[o] : by_z[o] * factor[b];
                if (p > 0) l.information(index[a], index[b]) += n * slope_a * slope_b / p;
            }
        }
    }
}

/// Log-likelihood of one free proportion per pair, and the number of these.
double saturated(Layout const& layout, std::span<PairCount const> pairs, int& free, double& constant)
{
    double sum = 0;
    for (PairCount const& pair : pairs) {
        double const half = layout.threshold ? 0 : pair.ties / 2, ties = layout.threshold ? pair.ties : 0;
        double const a = pair.first_wins + half, b = pair.second_wins + half, n = a + b + ties;
        if (n == 0) continue;
        free += layout.threshold ? 2 : 1;
        sum += x_log_x_over(a, n) + x_log_x_over(b, n) + x_log_x_over(ties, n);
        constant += std::lgamma(n + 1) - std::lgamma(a + 1) - std::lgamma(b + 1) - std::lgamma(ties + 1);
    }
    return sum;
}

void check_connected(Matrix const& wins)
{
    std::vector<int> const part = connected_parts(wins);
    for (std::size_t i = 0; i < part.size(); ++i)
        if (part[i] != 0)
            refuse("item " + std::to_string(i) + " is not connected with item 0 by any chain of comparisons",
                   "the distance between such items is unknown",
                   "scale the connected items separately, or add comparisons between them");
}

} // namespace

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

    Link const link{settings.model};
    Layout const layout{items, settings.order == OrderEffect::fitted && !pairs.empty(), threshold};
    LikelihoodAt const model = [&](std::span<double const> at, Likelihood& l) {
        l.clear(layout.count());
        for (PairCount const& p : pairs) add_pair(link, layout, p, at, l);
    };
    std::vector<double> start(layout.count(), 0);
    std::vector<Bound> bounds;
    if (threshold) {
        start.back() = 0.3;
        bounds.assign(layout.count(), {});
        bounds.back().low = 1e-3; // below, a tie has no probability
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
    if (layout.order) scale.order = estimate(layout.order_at());
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
