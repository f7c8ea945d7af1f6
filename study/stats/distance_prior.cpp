#include "study/stats/distance_prior.h"

#include "study/numeric/descent.h"
#include "study/numeric/error.h"
#include "study/numeric/special.h"
#include "study/stats/pair_scale.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace study {
namespace {

constexpr double kSigma = 1.4826; ///< as in pwcmp: 1 JOD = 75 %
constexpr double kFloor = 0.1;

/// A compared pair, i < j.
struct Met {
    std::size_t i, j;
    double wins, losses;
    double moved, total; ///< k' of n'
};

std::vector<Met> met_pairs(Matrix const& wins)
{
    std::vector<Met> met;
    for (std::size_t i = 0; i < wins.rows; ++i)
        for (std::size_t j = i + 1; j < wins.rows; ++j) {
            double const k = wins(i, j), l = wins(j, i);
            if (k + l == 0) continue;
            bool const unanimous = k == 0 || l == 0;
            met.push_back({i, j, k, l, !unanimous ? k : k == 0 ? 1 : k - 1, k + l});
        }
    return met;
}

/// Minus the penalised log-likelihood, and its gradient; scores are relative to the first.
/// a_c' depends on the counts of c' alone, which many pairs share, and swaps (i, j) with (j, i)
/// if c' is turned round, so that r is the same for both.
class PriorCost {
public:
    explicit PriorCost(std::vector<Met> met) : met_(std::move(met)), log_p_(met_.size()), log_q_(met_.size())
    {
        std::vector<double> const of_pairs(met_.size());
        for (Met const& m : met_) {
            double const fewer = std::min(m.moved, m.total - m.moved);
            auto it = std::find_if(counts_.begin(), counts_.end(),
                                   [&](Counts const& c) { return c.moved == fewer && c.total == m.total; });
            if (it == counts_.end()) it = counts_.insert(it, {fewer, m.total, 0, of_pairs, of_pairs});
            ++it->pairs;
        }
    }

    double value(std::span<double const> scores_but_first)
    {
        go_to(scores_but_first);
        double sum = 0;
        for (std::size_t c = 0; c < met_.size(); ++c)
            sum += met_[c].wins * log_p_[c] + met_[c].losses * log_q_[c] + std::log(kFloor + prior_[c]);
        return -2 * sum;
    }

    void gradient(std::span<double const> scores_but_first, std::span<double> g)
    {
        go_to(scores_but_first);
        std::size_t const n = met_.size();
        std::vector<double> up(n), down(n), by_z(n);
        for (std::size_t c = 0; c < n; ++c) {
            double const z = distance(met_[c]), log_density = -0.5 * z * z - kLogRootTwoPi;
            up[c] = std::exp(log_density - log_p_[c]);    // d log P / dz
            down[c] = -std::exp(log_density - log_q_[c]); // d log (1 - P) / dz
            by_z[c] = met_[c].wins * up[c] + met_[c].losses * down[c];
        }
        for (Counts const& k : counts_) {
            double const rest = k.total - k.moved;
            double mean = 0;
            for (std::size_t c = 0; c < n; ++c) mean += (k.share[c] + k.turned[c]) / (kFloor + prior_[c]);
            for (std::size_t c = 0; c < n; ++c)
                by_z[c] += k.pairs * (1 / (kFloor + prior_[c]) - mean) *
                           (k.share[c] * (k.moved * up[c] + rest * down[c]) +
                            k.turned[c] * (rest * up[c] + k.moved * down[c]));
        }
        std::fill(g.begin(), g.end(), 0.0);
        for (std::size_t c = 0; c < n; ++c) {
            if (met_[c].i > 0) g[met_[c].i - 1] -= 2 * by_z[c] / kSigma;
            g[met_[c].j - 1] += 2 * by_z[c] / kSigma;
        }
    }

private:
    /// k' of n' of some pairs, and a_c' at each pair and at it turned round, divided by their sum.
    struct Counts {
        double moved, total, pairs;
        std::vector<double> share, turned;
    };

    double distance(Met const& m) const { return ((m.i > 0 ? at_[m.i - 1] : 0) - at_[m.j - 1]) / kSigma; }

    void go_to(std::span<double const> scores_but_first)
    {
        // Gradients are asked for where the value was.
        if (!prior_.empty() && std::equal(at_.begin(), at_.end(), scores_but_first.begin())) return;
        at_.assign(scores_but_first.begin(), scores_but_first.end());
        std::size_t const n = met_.size();
        for (std::size_t c = 0; c < n; ++c) {
            double const z = distance(met_[c]);
            log_p_[c] = log_normal_cdf(z);
            log_q_[c] = log_normal_cdf(-z);
        }
        prior_.assign(n, 0);
        for (Counts& k : counts_) {
            double const rest = k.total - k.moved;
            double largest = -1e308, sum = 0;
            for (std::size_t c = 0; c < n; ++c) {
                k.share[c] = k.moved * log_p_[c] + rest * log_q_[c];
                k.turned[c] = rest * log_p_[c] + k.moved * log_q_[c];
                largest = std::max({largest, k.share[c], k.turned[c]});
            }
            for (std::size_t c = 0; c < n; ++c) {
                k.share[c] = std::exp(k.share[c] - largest);
                k.turned[c] = std::exp(k.turned[c] - largest);
                sum += k.share[c] + k.turned[c];
            }
            for (std::size_t c = 0; c < n; ++c) {
                k.share[c] /= sum;
                k.turned[c] /= sum;
                prior_[c] += k.pairs * (k.share[c] + k.turned[c]);
            }
        }
    }

    std::vector<Met> met_;
    std::vector<Counts> counts_;
    std::vector<double> at_, log_p_, log_q_, prior_;
};

} // namespace

std::vector<double> scale_with_distance_prior(Matrix const& wins)
{
    pairs_of(wins); // refuses invalid tables of counts
    std::vector<int> const part = connected_parts(wins);
    if (part.empty() || *std::max_element(part.begin(), part.end()) > 0)
        refuse("the items are not connected by comparisons", "distances between their groups are unknown",
               "scale each group by itself");
    PriorCost cost(met_pairs(wins));
    // The inverse of the second derivatives of the likelihood where all scores are equal; longer first steps may
    // end beyond a maximum, where there is none.
    double const trials = std::accumulate(wins.values.begin(), wins.values.end(), 0.0);
    double const first_step = double(wins.rows) * std::numbers::pi * kSigma * kSigma / (8 * trials);
    Minimum const found = minimise([&](std::span<double const> s) { return cost.value(s); },
                                   [&](std::span<double const> s, std::span<double> g) { cost.gradient(s, g); },
                                   std::vector<double>(wins.rows - 1, 0), 500, 1e-12, first_step);
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
