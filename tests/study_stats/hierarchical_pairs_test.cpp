// Scales with observers as random effects.

#include "study/numeric/random.h"
#include "study/stats/hierarchical_pairs.h"

#include <cmath>
#include <gtest/gtest.h>

namespace study::test {
namespace {

TEST(HierarchicalPairs, FindsScoresSpreadAndTies)
{
    std::vector<double> const truth{-0.8, 0, 0.8};
    double const between = 0.5, tie = 0.4;
    Random random(4);
    std::vector<std::vector<PairCount>> observers;
    for (int o = 0; o < 30; ++o) {
        std::vector<double> own;
        for (double const t : truth) own.push_back(t + between * random.normal());
        observers.emplace_back();
        for (int i = 0; i < 3; ++i)
            for (int j = i + 1; j < 3; ++j) {
                PairCount p{i, j};
                for (int r = 0; r < 8; ++r) {
                    double const d = own[std::size_t(i)] - own[std::size_t(j)] + random.normal();
                    (std::abs(d) < tie ? p.ties : d > 0 ? p.first_wins : p.second_wins) += 1;
                }
                observers.back().push_back(p);
            }
    }
    HierarchicalScale const s = hierarchical_scale(observers, 3, 0.95, {.warm_up = 200, .draws = 300, .seed = 2});
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(s.score[i].mean, truth[i], 3 * s.score[i].deviation);
        EXPECT_LT(s.score[i].deviation, 0.15);
        EXPECT_LT(s.score[i].low, s.score[i].high);
    }
    EXPECT_NEAR(s.between_sd.mean, between, 0.15);
    EXPECT_NEAR(s.tie_threshold.mean, tie, 0.06);
    ASSERT_EQ(s.difference.size(), 3u);
    EXPECT_NEAR(s.difference[1].mean, s.score[0].mean - s.score[2].mean, 1e-9);
    ASSERT_EQ(s.observer.size(), 30u);
    EXPECT_EQ(s.report.divergences, 0);
    EXPECT_LT(s.report.worst_r_hat, 1.05);
}

TEST(HierarchicalPairs, RefusesWhatHasNoSpreadOrScale)
{
    EXPECT_THROW(hierarchical_scale({{{0, 1, 1, 1}}}, 2), std::invalid_argument);
    EXPECT_THROW(hierarchical_scale({{{0, 1, 1, 1}}, {{0, 1, 1, 1}}}, 3), std::invalid_argument);
}

} // namespace
} // namespace study::test
