// Resampling of observers.

#include "study/stats/bootstrap.h"

#include "gi/core/quantile.h"
#include "study/numeric/random.h"
#include "study/stats/summary.h"
#include "tests/study_stats/bootstrap_pairs.h"
#include "tests/study_stats/support/study_data.h"

#include <cmath>
#include <map>

namespace study::test {
namespace {

TEST(Summary, OfTooFewIsNotANumber)
{
    EXPECT_TRUE(std::isnan(mean({})));
    EXPECT_TRUE(std::isnan(standard_deviation(std::vector<double>{1})));
}

TEST(Bootstrap, OfAMeanHasItsStandardError)
{
    Random random(2);
    std::vector<double> x(40);
    for (double& v : x) v = random.normal();
    auto const mean_of = [&](std::span<int const> drawn) {
        double sum = 0;
        for (int const d : drawn) sum += x[std::size_t(d)];
        return std::vector<double>{sum / 40};
    };
    Bootstrap const b = bootstrap(40, mean_of, {.replicates = 4000});
    double const expected = standard_deviation(x) / std::sqrt(40.0);
    EXPECT_NEAR(b.standard_error[0] / expected, 1, 0.06);
    std::vector<double> replicates;
    for (auto const& r : b.replicates) replicates.push_back(r[0]);
    EXPECT_LT(b.interval[0].low, gi::quantile(replicates, 0.025));
    EXPECT_GT(b.interval[0].high, gi::quantile(replicates, 0.975));
    EXPECT_EQ(bootstrap(40, mean_of, {.replicates = 50}).interval[0].low,
              bootstrap(40, mean_of, {.replicates = 50}).interval[0].low);
}

TEST(Bootstrap, OfPairsDrawsObserversAndNotTrials)
{
    // Two kinds of observers who answer every one of 50 trials alike: trials say p = 1/2 +- 0.03, people do not.
    std::vector<std::vector<PairCount>> observers;
    for (int o = 0; o < 8; ++o) observers.push_back({{0, 1, o % 2 ? 45.0 : 5.0, o % 2 ? 5.0 : 45.0}});
    Bootstrap const b = bootstrap_pairs(observers, 2, {.replicates = 500});
    PairScale const pooled = fit_pairs(pool(observers), 2);
    EXPECT_NEAR(pooled.score[0], 0, 1e-12);
    EXPECT_GT(b.standard_error[0], 3 * pooled.standard_error[0] * jod_per_unit(PairModel::thurstone_v));
    EXPECT_EQ(b.failed, 0);
    EXPECT_NEAR(b.interval[0].low, -b.interval[1].high, 1e-9);
}

TEST(Bootstrap, OfToneMappersOverlapsTheErrorsOfTheFit)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const trials = read_csv("pairs_tmo_video.csv");
    std::map<std::string, std::vector<PairCount>> by_observer;
    std::map<std::string, int> item;
    for (std::size_t r = 1; r < trials.size(); ++r)
        for (std::size_t c : {3u, 4u}) item.emplace(trials[r][c], 0);
    int count = 0;
    for (auto& [unused, index] : item) index = count++;
    for (std::size_t r = 1; r < trials.size(); ++r) {
        bool const a = trials[r][5] == "1";
        by_observer[trials[r][0]].push_back(
            {item.at(trials[r][3]), item.at(trials[r][4]), a ? 1.0 : 0.0, a ? 0.0 : 1.0});
    }
    std::vector<std::vector<PairCount>> observers;
    for (auto const& [unused, pairs] : by_observer) observers.push_back(pairs);
    ASSERT_EQ(observers.size(), 18u);
    Bootstrap const b = bootstrap_pairs(observers, 7, {.replicates = 300});
    std::vector<double> const jod =
        read_json("pairs_tmo_video.expected.json")["all"]["thurstone_case5"]["jod_mean0"]
            .get<std::vector<double>>();
    for (std::size_t i = 0; i < 7; ++i) {
        EXPECT_LT(b.interval[i].low, jod[i]);
        EXPECT_GT(b.interval[i].high, jod[i]);
        EXPECT_LT(b.standard_error[i], 0.35);
    }
}

TEST(Bootstrap, CountsReplicatesThatHaveNoResult)
{
    // Items 2 and 3 hang on one observer: without him or her there is no scale.
    std::vector<std::vector<PairCount>> observers(5, {{0, 1, 3, 2}, {1, 2, 2, 3}});
    observers[0].push_back({2, 3, 2, 3});
    Bootstrap const b = bootstrap_pairs(observers, 4, {.replicates = 400});
    EXPECT_NEAR(b.failed / 400.0, std::pow(0.8, 5), 0.08);
    EXPECT_EQ(b.replicates.size() + std::size_t(b.failed), 400u);
    auto const always_refuses = [](std::span<int const>) -> std::vector<double> {
        throw std::invalid_argument("nothing (why) else");
    };
    EXPECT_THROW(bootstrap(5, always_refuses), std::invalid_argument);
    EXPECT_THROW(bootstrap_pairs({{{0, 1, 1, 1}}}, 2, {}), std::invalid_argument);
    EXPECT_THROW(bootstrap_pairs({}, 2, {}), std::invalid_argument);
    EXPECT_THROW(bootstrap(5, always_refuses, {.replicates = 1}), std::invalid_argument);
    EXPECT_THROW(bootstrap(5, always_refuses, {.confidence = 1}), std::invalid_argument);
}

} // namespace
} // namespace study::test
