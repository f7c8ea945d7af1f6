// Do intervals of own thresholds hold them as often as they say, also near the ends of the levels?

#include "study/numeric/random.h"
#include "study/numeric/special.h"
#include "study/stats/own_threshold.h"

#include <cmath>
#include <gtest/gtest.h>
#include <span>
#include <tuple>
#include <vector>

namespace study::test {
namespace {

constexpr double kScale = 0.3;

double share_at(double level, double threshold) { return 0.5 + 0.5 * normal_cdf((level - threshold) / kScale); }

/// Of observers whose scale is known.
GroupThreshold known_group(bool are_levels_fixed)
{
    GroupThreshold g;
    g.shared = {0, kScale, 0.5, 0};
    g.are_levels_fixed = are_levels_fixed;
    g.observers = 4;
    return g;
}

GroupThresholdSettings settings()
{
    GroupThresholdSettings s;
    s.shape.sigmoid = Sigmoid::gaussian;
    s.low = 0;
    s.high = 2;
    s.lapse = 0;
    return s;
}

ObserverLevels answers_at(std::vector<double> const& levels, int trials, double threshold, Random& random)
{
    ObserverLevels o;
    for (double const level : levels) {
        o.counts.push_back({level, 0, double(trials)});
        for (int i = 0; i < trials; ++i) o.counts.back().correct += random.uniform() < share_at(level, threshold);
    }
    return o;
}

double share_held(double threshold)
{
    int held = 0;
    constexpr int kObservers = 1500;
    for (int i = 0; i < kObservers; ++i) {
        Random random = Random::part(29, std::uint64_t(i));
        auto const o = answers_at({0.4, 0.7, 1, 1.3, 1.6}, 12, threshold, random);
        PosteriorLevel const p = own_threshold(o, known_group(true), settings());
        held += p.low <= threshold && threshold <= p.high;
    }
    return double(held) / kObservers;
}

TEST(OwnThreshold, IsHeldAsOftenAsIntervalsSayAlsoNearTheEndsOfTheLevels)
{
    for (double const threshold : {0.5, 1.0, 1.5}) {
        double const held = share_held(threshold);
        EXPECT_GT(held, 0.935) << threshold;
        EXPECT_LT(held, 0.965) << threshold;
        RecordProperty("held at " + std::to_string(threshold), std::to_string(held));
    }
}

TEST(OwnThreshold, IsLessSureWhereTheScaleIs)
{
    ObserverLevels o;
    o.counts = {{1.6, 22, 24}}; // far above the threshold, at a distance that is a matter of scale
    GroupThreshold group = known_group(true);
    PosteriorLevel const known = own_threshold(o, group, settings());
    group.scale_error = 0.5;
    PosteriorLevel const unsure = own_threshold(o, group, settings());
    EXPECT_GT(unsure.deviation, 1.05 * known.deviation);
    EXPECT_GT(unsure.high - unsure.low, 1.05 * (known.high - known.low));
}

TEST(OwnThreshold, IsNotFarFromLevelsThatAreAllRight)
{
    ObserverLevels o;
    o.counts = {{0.4, 12, 12}, {1, 12, 12}, {1.6, 12, 12}};
    for (bool const are_fixed : {true, false}) {
        PosteriorLevel const p = own_threshold(o, known_group(are_fixed), settings());
        EXPECT_LT(p.high, 0.4);
        EXPECT_GT(p.low, 0.4 - 5 * kScale);
    }
}

TEST(OwnThreshold, IsFiniteForAStepBetweenLevels)
{
    ObserverLevels o;
    o.counts = {{0.4031, 6, 12}, {1.6017, 12, 12}};
    GroupThreshold group = known_group(true);
    group.shared.scale = 1e-5; // nothing on the grid of places informs
    PosteriorLevel const p = own_threshold(o, group, settings());
    EXPECT_GT(p.low, 0.39);
    EXPECT_LT(p.high, 1.61);
    EXPECT_LT(p.low, p.high);
}

TEST(OwnThreshold, TellsFixedLevelsFromThoseThatFollowAnswers)
{
    Random random(2);
    std::vector<ObserverLevels> people;
    for (int i = 0; i < 4; ++i) people.push_back(answers_at({0.4, 0.7, 1, 1.3, 1.6}, 12, 1, random));
    people[1].counts[2].trials = 9; // three answers came too early
    people[1].counts[2].correct = std::min(people[1].counts[2].correct, 9.0);
    EXPECT_TRUE(group_threshold(people, settings()).are_levels_fixed);
    people[1].counts[2].trials = 2;
    people[1].counts[2].correct = 1;
    EXPECT_FALSE(group_threshold(people, settings()).are_levels_fixed);
    people[1] = answers_at({0.4, 0.7, 1, 1.3, 1.5}, 12, 1, random);
    EXPECT_FALSE(group_threshold(people, settings()).are_levels_fixed);
}

/// How often the interval of the deviation between observers holds it.
double deviation_held(double deviation, int observers, int trials)
{
    int held = 0;
    constexpr int kStudies = 120;
    for (int i = 0; i < kStudies; ++i) {
        Random random = Random::part(31, std::uint64_t(i));
        std::vector<ObserverLevels> people;
        for (int o = 0; o < observers; ++o)
            people.push_back(answers_at({0.4, 0.7, 1, 1.3, 1.6}, trials, 1 + deviation * random.normal(), random));
        Interval const found = group_threshold(people, settings()).deviation_interval;
        held += found.low <= deviation && deviation <= found.high;
    }
    return double(held) / kStudies;
}

TEST(GroupThreshold, HoldsTheDeviationBetweenObserversAsOftenAsItSays)
{
    for (auto const& [deviation, observers, trials] :
         {std::tuple(0.02, 6, 16), {0.1, 4, 16}, {0.3, 6, 16}}) {
        double const held = deviation_held(deviation, observers, trials);
        EXPECT_GE(held, 0.9) << deviation << " " << observers;
        RecordProperty("held at " + std::to_string(deviation) + " by " + std::to_string(observers),
                       std::to_string(held));
    }
}

TEST(GroupThreshold, HasNoDeviationOfOneObserverAndWideOnesOfFew)
{
    Random random = Random::part(32, 0);
    std::vector<ObserverLevels> people;
    for (int o = 0; o < 3; ++o) people.push_back(answers_at({0.4, 0.7, 1, 1.3, 1.6}, 16, 1, random));
    EXPECT_TRUE(std::isnan(group_threshold(std::span(people).first(1), settings()).deviation_interval.low));
    GroupThreshold const g = group_threshold(people, settings());
    EXPECT_LT(g.deviation_interval.low, 0.02);
    EXPECT_GT(g.deviation_interval.high, 0.2) << "three equal observers do not show that all are";
    GroupThresholdSettings without = settings();
    without.has_deviation = false;
    EXPECT_TRUE(std::isnan(group_threshold(people, without).deviation_interval.high));
}

} // namespace
} // namespace study::test
