// Scales with errors over observers.

#include "study/numeric/random.h"
#include "study/stats/observer_scale.h"
#include "tests/study_stats/bootstrap_pairs.h"

#include <cmath>
#include <gtest/gtest.h>

namespace study::test {
namespace {

std::vector<std::vector<PairCount>> simulated(int people, int repeats, std::vector<double> const& truth,
                                              double between, double tie, std::uint64_t seed)
{
    Random random(seed);
    std::vector<std::vector<PairCount>> data;
    int const items = int(truth.size());
    for (int o = 0; o < people; ++o) {
        std::vector<double> own;
        for (double const t : truth) own.push_back(t + between * random.normal());
        data.emplace_back();
        for (int i = 0; i < items; ++i)
            for (int j = i + 1; j < items; ++j) {
                PairCount p{i, j};
                for (int r = 0; r < repeats; ++r) {
                    double const d = own[std::size_t(i)] - own[std::size_t(j)] + random.normal();
                    (std::abs(d) < tie ? p.ties : d > 0 ? p.first_wins : p.second_wins) += 1;
                }
                data.back().push_back(p);
            }
    }
    return data;
}

TEST(ObserverScale, OfIndependentTrialsHasTheErrorsOfTheFit)
{
    auto const data = simulated(400, 2, {-0.6, 0, 0.6}, 0, 0, 5);
    ObserverScale const s = scale_observers(data, 3);
    EXPECT_NEAR(s.dispersion, 1, 0.1);
    for (int i = 0; i < 3; ++i) {
        Contrast const c = score_of(s, i);
        EXPECT_NEAR(c.standard_error / s.fit.standard_error[std::size_t(i)], 1, 0.1);
        EXPECT_DOUBLE_EQ(c.value, s.fit.score[std::size_t(i)]);
        EXPECT_LT(c.interval.low, c.value);
        EXPECT_GT(c.interval.high, c.value);
    }
    Contrast const d = difference_of(s, 2, 0);
    EXPECT_NEAR(d.value, s.fit.score[2] - s.fit.score[0], 1e-12);
    EXPECT_LT(d.p, 1e-10);
}

TEST(ObserverScale, OfObserversWhoDifferHasLargerErrors)
{
    auto const data = simulated(60, 8, {-0.3, 0.3}, 0.8, 0, 6);
    ObserverScale const s = scale_observers(data, 2);
    EXPECT_GT(s.dispersion, 3);
    Bootstrap const b = bootstrap_pairs(data, 2, {.replicates = 800});
    double const jod = jod_per_unit(PairModel::thurstone_v);
    EXPECT_NEAR(score_of(s, 0).standard_error * jod / b.standard_error[0], 1, 0.12);
}

TEST(ObserverScale, OfObserversWithUnitsOfTheirOwnModelsLargerErrorsOfTheEnds)
{
    std::vector<std::vector<PairCount>> data;
    for (std::uint64_t o = 0; o < 600; ++o) {
        double const unit = o % 2 ? 0.5 : 1.5;
        data.push_back(simulated(1, 4, {-2 * unit, -0.7 * unit, 0, 0.7 * unit, 2 * unit}, 0.2, 0, o).front());
    }
    ObserverScale const s = scale_observers(data, 5);
    for (std::size_t i = 0; i < 5; ++i) {
        double observed = 0;
        for (auto const& moved : s.influence) observed += moved[i] * moved[i];
        EXPECT_NEAR(s.modelled(i, i) / observed, 1, 0.15) << i;
    }
}

TEST(ObserverScale, WithAThresholdOfTiesDoesNotShrink)
{
    std::vector<double> const truth{-0.8, 0, 0.8};
    auto const data = simulated(500, 3, truth, 0, 0.5, 7);
    ObserverScale const s = scale_observers(data, 3, {.ties = TieModel::threshold});
    ASSERT_TRUE(s.fit.tie_threshold);
    EXPECT_NEAR(s.fit.tie_threshold->value, 0.5, 0.03);
    EXPECT_NEAR(s.fit.score[2] - s.fit.score[0], 1.6, 0.06);
    PairScale const halves = fit_pairs(pool(data), 3);
    EXPECT_LT(halves.score[2] - halves.score[0], 1.5) << "half wins shrink";
}

TEST(ObserverScale, OfUnanimousChoicesIsFiniteAndCautious)
{
    std::vector<std::vector<PairCount>> const data(6, {{0, 1, 2, 0}, {1, 2, 1, 1}, {0, 2, 2, 0}});
    ObserverScale const s = scale_observers(data, 3);
    Contrast const c = difference_of(s, 0, 2);
    EXPECT_TRUE(std::isfinite(c.interval.low));
    EXPECT_GT(c.interval.high - c.interval.low, 1);
    EXPECT_GT(c.interval.low, 0);
}

TEST(ObserverScale, OfAScoreThatOneObserverDeterminesHasFewDegreesOfFreedom)
{
    std::vector<std::vector<PairCount>> data(30, {{0, 1, 3, 2}, {1, 2, 2, 3}});
    data[0].push_back({2, 3, 12, 13});
    ObserverScale const s = scale_observers(data, 4);
    EXPECT_LT(difference_of(s, 2, 3).degrees_of_freedom, 8);
    EXPECT_GT(difference_of(s, 0, 1).degrees_of_freedom, 25);
}

TEST(ObserverScale, OfManyItemsLetsOneBeDisputed)
{
    double share = 0;
    int const experiments = 40;
    for (int e = 0; e < experiments; ++e) {
        Random random(100 + std::uint64_t(e));
        std::vector<std::vector<PairCount>> data;
        for (std::uint64_t o = 0; o < 24; ++o) {
            std::vector<double> own;
            for (int i = 0; i < 12; ++i) own.push_back(0.25 * i - 1.5);
            own[6] += random.normal();
            data.push_back(simulated(1, 1, own, 0, 0, 1000 * std::uint64_t(e) + o).front());
        }
        ObserverScale const s = scale_observers(data, 12);
        double observed = 0;
        for (auto const& moved : s.influence) observed += moved[6] * moved[6];
        share += std::pow(score_of(s, 6).standard_error, 2) / observed / experiments;
    }
    EXPECT_GT(share, 0.85);
}

/// Ten observers whose units differ (0.5 in the logarithm) on a wide scale.
std::vector<std::vector<PairCount>> of_unequal_units(std::uint64_t seed)
{
    std::vector<std::vector<PairCount>> data;
    for (std::uint64_t o = 0; o < 10; ++o) {
        Random random = Random::part(seed, o);
        double const unit = std::exp(0.5 * random.normal());
        data.push_back(
            simulated(1, 2, {-2.2 * unit, -unit, 0.2 * unit, unit, 2 * unit}, 0.2, 0, 100 * seed + o).front());
    }
    return data;
}

TEST(ObserverScale, KnowsThatFarOffChoicesWeighMoreIfObserversDiffer)
{
    int const experiments = 300;
    double variance = 0, sum = 0, squares = 0;
    for (int e = 0; e < experiments; ++e) {
        Contrast const c = score_of(scale_observers(of_unequal_units(1 + std::uint64_t(e)), 5), 0);
        variance += c.standard_error * c.standard_error / experiments;
        sum += c.reduced / experiments;
        squares += c.reduced * c.reduced / experiments;
    }
    RecordProperty("ratio", std::to_string(variance / (squares - sum * sum)));
    EXPECT_GT(variance / (squares - sum * sum), 0.9);
    EXPECT_LT(variance / (squares - sum * sum), 1.3);
}

TEST(ObserverScale, ByLeavingOutIsTheSandwichWhereScoresAreLinear)
{
    auto const data = simulated(200, 3, {-0.5, 0, 0.5}, 0.3, 0, 8);
    ObserverScale const s = scale_observers(data, 3);
    for (std::size_t i = 0; i < 3; ++i) {
        double linear = 0, left_out = 0;
        for (auto const& moved : s.influence) linear += moved[i] * moved[i];
        for (auto const& moved : s.left_out) left_out += moved[i] * moved[i];
        EXPECT_NEAR(left_out / linear, 1, 0.01) << i;
    }
}

TEST(ObserverScale, KnowsAnErrorThatFollowsFromTheScore)
{
    // One choice of each: how many choose the first is all there is to know.
    std::vector<std::vector<PairCount>> data(30, {{0, 1, 1, 0}});
    for (std::size_t o = 0; o < 9; ++o) data[o] = {{0, 1, 0, 1}};
    EXPECT_GT(score_of(scale_observers(data, 2), 0).degrees_of_freedom, 100);
    // With more choices of each, how much observers differ is to be estimated.
    for (auto& own : data) own.front() = {0, 1, 10 * own.front().first_wins + 2, 10 * own.front().second_wins + 2};
    EXPECT_NEAR(score_of(scale_observers(data, 2), 0).degrees_of_freedom, 29, 8);
}

TEST(ObserverScale, RefusesOneObserverAndWrongWeights)
{
    EXPECT_THROW(scale_observers({{{0, 1, 1, 1}}}, 2), std::invalid_argument);
    ObserverScale const s = scale_observers({{{0, 1, 1, 1}}, {{0, 1, 1, 2}}}, 2);
    EXPECT_THROW(contrast(s, std::vector<double>{1}), std::invalid_argument);
    EXPECT_EQ(scale_observers({{}, {}}, 1).fit.score.size(), 1u);
}

} // namespace
} // namespace study::test
