#include "study/stats/distance_prior.h"

#include "study/stats/descent.h"
#include "study/stats/error.h"
#include "study/stats/pair_scale.h"
#include "study/stats/special.h"

#include <algorithm>
#include <cmath>

namespace study {
namespace {

constexpr double kSigma = 1.4826; ///< as in pwcmp: 1 JOD = 75 %
constexpr double kFloor = 0.1;

/// A compared ordered pair.
struct Met {
    std::size_t i, j;
    double wins, losses;
    double moved, total; ///< k' of n'
};

std::vector<Met> met_pairs(Matrix const& wins)
{
    std::vector<Met> met;
    for (std::size_t j = 0; j < wins.rows; ++j)
        for (std::size_t i = 0; i < wins.rows; ++i) {
            double const k = wins(i, j), l = wins(j, i);
            if (i == j || k + l == 0) continue;
            bool const unanimous = k == 0 || l == 0;
            met.push_back({i, j, k, l, !unanimous ? k : k == 0 ? 1 : k - 1, k + l});
        }
    return met;
}

double cost(std::vector<Met> const& met, std::span<double const> scores_but_first)
{
    auto const score = [&](std::size_t i) { return i == 0 ? 0 : scores_but_first[i - 1]; };
    std::size_t const n = met.size();
    std::vector<double> log_p(n), log_q(n), prior(n, 0), a(n);
    double sum = 0;
    for (std::size_t c = 0; c < n; ++c) {
        double const z = (score(met[c].i) - score(met[c].j)) / kSigma;
        log_p[c] = log_normal_cdf(z);
        log_q[c] = log_normal_cdf(-z);
        sum += met[c].wins * log_p[c] + met[c].losses * log_q[c];
    }
    for (Met const& m : met) {
        double largest = -1e308, total = 0;
        for (std::size_t c = 0; c < n; ++c) {
            a[c] = m.moved * log_p[c] + (m.total - m.moved) * log_q[c];
            largest = std::max(largest, a[c]);
        }
        for (std::size_t c = 0; c < n; ++c) total += a[c] = std::exp(a[c] - largest);
        for (std::size_t c = 0; c < n; ++c) prior[c] += a[c] / total;
    }
    for (double const r : prior) sum += std::log(kFloor + r);
    return -sum;
}

} // namespace

std::vector<double> scale_with_distance_prior(Matrix const& wins)
{
    pairs_of(wins); // refuses invalid tables of counts
    std::vector<int> const part = connected_parts(wins);
    if (part.empty() || *std::max_element(part.begin(), part.end()) > 0)
        refuse("the items are not connected by comparisons", "distances between their groups are unknown",
               "scale each group by itself");
    std::vector<Met> const met = met_pairs(wins);
    Minimum const found =
        minimise([&](std::span<double const> s) { return cost(met, s); }, std::vector<double>(wins.rows - 1, 0));
    std::vector<double> score(1, 0);
    score.insert(score.end(), found.at.begin(), found.at.end());
    double mean = 0;
    for (double const s : score) mean += s / double(score.size());
    for (double& s : score) {
        s -= mean;
        if (!(std::abs(s) < 12))
            refuse("the distance prior has no finite maximum here", "too many pairs were unanimous",
                   "use fit_pairs, whose prior always has one");
    }
    return score;
}

} // namespace study
