#include "study/stats/outliers.h"

#include "gi/core/quantile.h"
#include "study/numeric/error.h"
#include "study/numeric/rounding.h"
#include "study/numeric/special.h"
#include "study/stats/binomial.h"
#include "study/stats/distance_prior.h"
#include "study/stats/pair_scale.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace study {
namespace {

[[noreturn]] void refuse_so_few()
{
    refuse("outliers among fewer than three observers", "each is judged by the spread of the others",
           "ask more observers");
}

void check(std::vector<std::vector<Matrix>> const& wins)
{
    if (wins.empty() || wins.front().size() < 3) refuse_so_few();
    for (auto const& scene : wins)
        for (Matrix const& observer : scene)
            if (scene.size() != wins.front().size() || observer.rows != scene.front().rows ||
                observer.columns != observer.rows)
                refuse("scenes with different observers or items", "likelihoods are summed over scenes",
                       "give every observer a square table in every scene, with zeros if nothing was seen");
}

/// Scores in the unit of fit_pairs.
std::vector<double> scale(Matrix const& wins)
{
    try {
        std::vector<double> score = scale_with_distance_prior(wins);
        for (double& s : score) s /= jod_per_unit(PairModel::thurstone_v);
        return score;
    } catch (std::invalid_argument const&) {
        return fit_pairs(pairs_of(wins), int(wins.rows)).score;
    }
}

void add_log_likelihood(Matrix const& wins, std::vector<double> const& score, double& sum, int& pairs)
{
    for (std::size_t i = 0; i < wins.rows; ++i)
        for (std::size_t j = i + 1; j < wins.rows; ++j)
            if (double const n = wins(i, j) + wins(j, i); n > 0) {
                sum += std::max(std::log(1e-200), log_binomial(wins(i, j), n, normal_cdf(score[i] - score[j])));
                ++pairs;
            }
}

} // namespace

std::vector<ObserverFit> observer_outliers(std::vector<std::vector<Matrix>> const& wins)
{
    check(wins);
    std::size_t const observers = wins.front().size();
    std::vector<double> sum(observers, 0);
    std::vector<int> pairs(observers, 0);
    for (auto const& scene : wins) {
        std::size_t const items = scene.front().rows;
        for (std::size_t o = 0; o < observers; ++o) {
            Matrix others(items, items);
            for (std::size_t p = 0; p < observers; ++p)
                for (std::size_t k = 0; p != o && k < others.values.size(); ++k)
                    others.values[k] += scene[p].values[k];
            add_log_likelihood(scene[o], scale(others), sum[o], pairs[o]);
        }
    }
    std::vector<double> known;
    for (std::size_t o = 0; o < observers; ++o) {
        sum[o] = pairs[o] > 0 ? sum[o] / pairs[o] : std::nan("");
        if (pairs[o] > 0) known.push_back(sum[o]);
    }
    if (known.size() < 3) refuse_so_few();
    // MATLAB's quantiles, as in pwcmp, to reproduce its published scores.
    double const q25 = gi::hazen_quantile(known, 0.25), range = gi::hazen_quantile(known, 0.75) - q25;
    std::vector<ObserverFit> result;
    for (double const l : sum) {
        // Of observers who agree alike, scores by solvers differ in their last digits.
        double const least = kSolverNoise * std::abs(q25), below = q25 - l > least ? q25 - l : 0;
        double const none = below > 0 ? std::numeric_limits<double>::infinity() : 0;
        result.push_back({l, range > least ? below / range : none});
    }
    return result;
}

} // namespace study
