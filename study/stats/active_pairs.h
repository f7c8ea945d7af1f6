#pragma once
// Which pair to show next: the one whose answer is expected to say most about the scores (active sampling, as
// ASAP: Mikhailiuk, Wilmot, Perez-Ortiz, Yue, Mantiuk 2021, ICPR, arXiv:2004.05691; information gain in closed
// form for probit choices: Houlsby et al. 2011, arXiv:1112.5745).
//
// The posterior of the scores is the normal approximation at its mode (Laplace), of Thurstone's model with
// P(first is chosen) = Phi(s_first - s_second) and a normal prior. An answer depends on the scores only through
// d = s_first - s_second ~ N(m, v), so its expected gain is the mutual information H(E Phi(d)) - E H(Phi(d)).
// In batches (the usual), the pairs are the edges of the spanning tree of all items with the most gain, in random
// order: every item is shown in each, and answers between updates need no wait. Ties within 1e-9 bits are broken
// by the seed, so that rounding does not decide.

#include "study/stats/matrix.h"
#include "study/stats/random.h"

#include <deque>
#include <optional>
#include <span>
#include <utility>

namespace study {

struct ActiveSettings {
    bool is_batch = true; ///< false: the posterior is updated after each answer
    double prior_sd = 3;  ///< of scores, in units of F
    std::uint64_t seed = 0;
};

/// An answer about a pair of items. first_wins  1: the first was chosen, 0: the second, 1/2: neither
struct PairAnswer {
    std::pair<int, int> pair;
    double first_wins = 0;
};
/// Normal approximation of the posterior of the scores at its mode, in units of F; the prior makes their mean 0.
struct PairPosterior {
    std::vector<double> mode;
    Matrix covariance;
};
/// @param start  of the search, such as an earlier mode; empty = all 0
PairPosterior pair_posterior(int items, std::span<PairAnswer const> answers, double prior_sd,
                             std::vector<double> const& start = {});

class ActivePairs {
public:
    using Pair = std::pair<int, int>;

    /// @param allowed  pairs of items that may be shown; they connect all items, or a batch is a forest
    /// @throws std::invalid_argument no pair, or an item out of range or paired with itself
    ActivePairs(int items, std::vector<Pair> allowed, ActiveSettings const& settings);

    /// The pair to show now, as in `allowed`. It depends only on the settings and on the calls so far.
    Pair next() const { return queue_.front(); }
    /// The pair was shown. @param first_wins  1: the first was chosen, 0: the second, 1/2: neither; none = there
    /// was no valid answer
    void shown(Pair pair, std::optional<double> first_wins);

    int answers() const { return int(answers_.size()); }
    /// Mode and covariance of the posterior, in units of F; the prior makes the mean of the scores 0.
    std::vector<double> const& scores() const { return posterior_.mode; }
    Matrix const& covariance() const { return posterior_.covariance; }
    /// Expected information of an answer, bits.
    double gain(Pair pair) const;

private:
    void choose();

    int items_;
    std::vector<Pair> allowed_;
    ActiveSettings settings_;
    Random random_;
    std::vector<PairAnswer> answers_;
    PairPosterior posterior_;
    bool is_outdated_ = false;
    std::deque<Pair> queue_;
};

} // namespace study
