#pragma once
// Which pair to show next: the one whose answer is expected to make the scores' errors smallest (active sampling
// of pairs, as ASAP: Mikhailiuk, Wilmot, Perez-Ortiz, Yue, Mantiuk 2021, ICPR, arXiv:2004.05691, but not for the
// most information about their order and distances).
//
// The criterion is the sum of the posterior variances of the scores around their mean (A-optimality: Chaloner &
// Verdinelli 1995, Statistical Science 10:273), for the posterior of pair_posterior.h with covariance C. An answer
// about a pair with the difference d ~ N(m, v) has the information w = phi(d)^2 / (Phi(d) Phi(-d)), after which
// C is C - c c^T w / (1 + w v), c = the pair's column of C. For w the difference is taken one posterior standard
// deviation nearer to 0 than m: otherwise pairs that seem far apart by chance are no longer shown, so that the
// error stays, and scales whose items are all near each other come out worse than with random pairs.
// In trees, the pairs are the edges of a spanning tree of all items, chosen one after the other as if
// the answers before had been given, and shown in random order. Ties within 1e-9 are broken by the seed,
// so that rounding does not decide.

#include "study/adaptive/pair_posterior.h"
#include "study/numeric/random.h"

#include <cstdint>
#include <deque>
#include <optional>

namespace study {

struct ActiveSettings {
    bool is_tree = false; ///< choose a spanning tree at a time; false: one pair, another one, after each answer
    double prior_sd = 3;  ///< of scores, in units of F
    std::uint64_t seed = 0;
};

class ActivePairs {
public:
    using Pair = std::pair<int, int>;

    /// @param allowed  pairs of items that may be shown; they connect all items, or a tree is a forest
    /// @throws std::invalid_argument no pair, or an item out of range or paired with itself
    ActivePairs(int items, std::vector<Pair> allowed, ActiveSettings const& settings);

    /// The pair to show now, as in `allowed`. It depends only on the settings and on the calls so far.
    Pair next() const { return queue_.front(); }
    /// The pair was shown.  @param first_wins  1: the first was chosen, 0: the second,
    /// 1/2: neither; none = there was no valid answer
    void shown(Pair pair, std::optional<double> first_wins);

    /// Mean and covariance of the posterior, in units of F; the prior makes the mean of the scores 0.
    std::vector<double> const& scores() const { return posterior_.mean(); }
    Matrix const& covariance() const { return posterior_.covariance(); }
    /// By how much an answer is expected to lower the sum of the scores' variances, squared units of F.
    double gain(Pair pair) const;

private:
    void choose();

    int items_;
    std::vector<Pair> allowed_;
    ActiveSettings settings_;
    Random random_;
    RunningPairPosterior posterior_;
    int answers_ = 0;
    Pair last_{-1, -1};
    std::deque<Pair> queue_;
};

} // namespace study
