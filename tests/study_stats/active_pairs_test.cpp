// Active sampling of pairs: the posterior, the expected information, and what it chooses.

#include "study/stats/active_pairs.h"
#include "study/stats/pair_scale.h"
#include "study/stats/special.h"

#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace study {
namespace {

std::vector<ActivePairs::Pair> all_pairs(int n)
{
    std::vector<ActivePairs::Pair> pairs;
    for (int a = 0; a < n; ++a)
        for (int b = a + 1; b < n; ++b) pairs.emplace_back(a, b);
    return pairs;
}

double entropy(double p) { return p > 0 && p < 1 ? -p * std::log2(p) - (1 - p) * std::log2(1 - p) : 0; }

TEST(ActivePairs, ExpectedInformationIsThatOfTheDefinition)
{
    ActivePairs pairs(3, all_pairs(3), {true, 1, 7});
    pairs.shown({0, 1}, 1);
    pairs.shown({0, 2}, 1);
    pairs.shown({1, 2}, 0);
    for (auto const& [a, b] : all_pairs(3)) {
        // H(y) - E H(y|d) by a sum over a fine grid of d.
        double const m = pairs.scores()[std::size_t(a)] - pairs.scores()[std::size_t(b)];
        Matrix const& c = pairs.covariance();
        auto const [i, j] = std::pair{std::size_t(a), std::size_t(b)};
        double const v = c(i, i) + c(j, j) - 2 * c(i, j);
        double p = 0, h = 0;
        for (int k = -8000; k <= 8000; ++k) {
            double const z = k / 1000.0, w = normal_pdf(z) / 1000, f = normal_cdf(m + std::sqrt(v) * z);
            p += w * f;
            h += w * entropy(f);
        }
        EXPECT_NEAR(pairs.gain({a, b}), entropy(p) - h, 2e-6) << a << " " << b;
    }
}

TEST(ActivePairs, PosteriorModeIsThatOfFitPairsWithAWidePrior)
{
    std::vector<PairCount> const counts{{0, 1, 6, 4, 0}, {1, 2, 7, 3, 0}, {0, 2, 9, 2, 0}};
    ActivePairs pairs(3, all_pairs(3), {false, 1000, 7}); // updates at once
    for (PairCount const& c : counts) {
        for (int i = 0; i < int(c.first_wins); ++i) pairs.shown({c.first, c.second}, 1);
        for (int i = 0; i < int(c.second_wins); ++i) pairs.shown({c.first, c.second}, 0);
    }
    PairScale const fit = fit_pairs(counts, 3);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(pairs.scores()[i], fit.score[i], 1e-4) << i;
}

TEST(ActivePairs, ABatchIsASpanningTree)
{
    ActivePairs pairs(7, all_pairs(7), {true, 3, 5});
    for (int batch = 0; batch < 5; ++batch) {
        std::set<int> seen;
        std::set<ActivePairs::Pair> edges;
        for (int i = 0; i < 6; ++i) {
            auto const p = pairs.next();
            seen.insert({p.first, p.second});
            EXPECT_TRUE(edges.insert(p).second) << "twice in a batch";
            pairs.shown(p, p.first < p.second ? 1 : 0);
        }
        EXPECT_EQ(seen.size(), 7u);
    }
}

TEST(ActivePairs, DependOnSeedAndAnswersOnly)
{
    for (bool const is_batch : {true, false}) {
        auto const run = [&](std::uint64_t seed, int flip) {
            ActivePairs pairs(5, all_pairs(5), {is_batch, 3, seed});
            std::vector<ActivePairs::Pair> shown;
            for (int i = 0; i < 24; ++i) {
                shown.push_back(pairs.next());
                pairs.shown(shown.back(), i == flip ? 0.0 : 1.0);
            }
            return shown;
        };
        EXPECT_EQ(run(1, -1), run(1, -1));
        EXPECT_NE(run(1, -1), run(2, -1));
        EXPECT_NE(run(1, -1), run(1, 2));
    }
}

TEST(ActivePairs, AreNotThoseWhoseOrderIsKnown)
{
    // Ten levels 1 JOD apart: neighbours say more about the scale than the two ends.
    Random random(3);
    ActivePairs pairs(10, all_pairs(10), {true, 3, 9});
    int near = 0, far = 0;
    for (int i = 0; i < 270; ++i) {
        auto const [a, b] = pairs.next();
        double const p = normal_cdf((a - b) / 1.4826);
        near += b - a <= 2;
        far += b - a >= 6;
        pairs.shown({a, b}, random.uniform() < p ? 1 : 0);
    }
    EXPECT_GT(near, 1.3 * 270 * 17 / 45.0) << "17 of 45 pairs";
    EXPECT_LT(far, 0.7 * 270 * 10 / 45.0) << "10 of 45 pairs";
}

TEST(ActivePairs, RefuseWhatCannotBeShown)
{
    EXPECT_THROW(ActivePairs(3, {}, {}), std::invalid_argument);
    EXPECT_THROW(ActivePairs(3, {{0, 3}}, {}), std::invalid_argument);
    EXPECT_THROW(ActivePairs(3, {{1, 1}}, {}), std::invalid_argument);
}

} // namespace
} // namespace study
