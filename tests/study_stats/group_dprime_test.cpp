// Mean d' of populations: models against their equations, estimates against simulated observers.

#include "study/stats/group_dprime.h"

#include "study/numeric/random.h"
#include "study/numeric/special.h"
#include "tests/study_stats/dprime_by_rates.h"

#include <cmath>
#include <gtest/gtest.h>
#include <span>

namespace study::test {
namespace {

constexpr DetectionTask kTasks[] = {DetectionTask::yes_no, DetectionTask::two_interval,
                                    DetectionTask::same_different, DetectionTask::abx, DetectionTask::oddity};

TEST(DetectionModel, IsTheInverseOfDPrime)
{
    for (double d : {0.3, 1.0, 2.5}) {
        auto const rates = [&](DetectionTask task, double c) { return detection_rates(task, d, c); };
        for (double c : {0.25, 0.8}) {
            auto const yes = rates(DetectionTask::yes_no, c);
            EXPECT_NEAR(normal_quantile(yes.hit.yes) - normal_quantile(yes.false_alarm.yes), d, 1e-12);
            auto const same = rates(DetectionTask::same_different, c);
            EXPECT_NEAR(same_different_dprime(same.hit.yes, same.false_alarm.yes), d, 1e-9);
            auto const abx = rates(DetectionTask::abx, c);
            EXPECT_NEAR(abx_dprime(abx.hit.yes, abx.false_alarm.yes), d, 1e-9);
        }
        EXPECT_NEAR(rates(DetectionTask::two_interval, 0).hit.yes, normal_cdf(d / std::sqrt(2.0)), 1e-12);
        EXPECT_NEAR(oddity_dprime(rates(DetectionTask::oddity, 0).hit.yes), d, 1e-9);
    }
}

TEST(DetectionModel, HasTheDerivativesOfItsLikelihoodOnBothSidesOfZero)
{
    DetectionCounts const counts{13, 20, 8, 22};
    for (DetectionTask const task : kTasks)
        for (double d : {-2.1, -0.4, 0.2, 1.7})
            for (double c : {-0.5, 0.6}) {
                auto const at = [&](double x, double y) { return detection_likelihood(task, counts, x, y).value; };
                auto const l = detection_likelihood(task, counts, d, c);
                double const h = 1e-6;
                EXPECT_NEAR(l.by_dprime, (at(d + h, c) - at(d - h, c)) / (2 * h), 1e-5) << int(task) << " " << d;
                EXPECT_NEAR(l.by_criterion, (at(d, c + h) - at(d, c - h)) / (2 * h), 1e-5)
                    << int(task) << " " << d;
                DetectionRates const r = detection_rates(task, d, c);
                EXPECT_NEAR(r.hit.yes + r.hit.no, 1, 1e-12);
            }
}

TEST(DetectionModel, PutsAnswersBelowChanceBelowZero)
{
    EXPECT_LT(detection_point(DetectionTask::oddity, {8, 30, 0, 0}).dprime, -0.3);
    EXPECT_GT(detection_point(DetectionTask::oddity, {12, 30, 0, 0}).dprime, 0.3);
    for (DetectionTask const task : {DetectionTask::abx, DetectionTask::same_different}) {
        double const above = detection_point(task, {10, 15, 5, 15}).dprime;
        double const below = detection_point(task, {5, 15, 10, 15}).dprime;
        EXPECT_GT(above, 0.5);
        EXPECT_LT(below, -0.5);
    }
}

std::vector<DetectionCounts> simulated(DetectionTask task, double mean, double sd, int observers, int trials,
                                       std::uint64_t seed)
{
    Random random(seed);
    std::vector<DetectionCounts> out;
    for (int o = 0; o < observers; ++o) {
        double const d = mean + sd * random.normal(), c = 0.2 + 0.2 * random.normal();
        DetectionRates const r = detection_rates(task, d, c);
        DetectionCounts n;
        n.signals = has_criterion(task) ? trials / 2 : trials;
        n.noises = trials - n.signals;
        for (int i = 0; i < n.signals; ++i) n.hits += random.uniform() < r.hit.yes;
        for (int i = 0; i < n.noises; ++i) n.false_alarms += random.uniform() < r.false_alarm.yes;
        out.push_back(n);
    }
    return out;
}

TEST(GroupDPrime, FindsMeanAndSpreadOfManyObservers)
{
    for (DetectionTask const task : kTasks) {
        GroupDPrime const g = group_dprime(task, simulated(task, 1.5, 0.5, 120, 80, 5));
        EXPECT_NEAR(g.mean, 1.5, 0.2) << int(task);
        EXPECT_NEAR(g.deviation, 0.5, 0.2) << int(task);
        EXPECT_LT(g.interval.low, 1.55) << int(task); // the sample has a mean of its own
        EXPECT_GT(g.interval.high, 1.45) << int(task);
        EXPECT_LT(g.p, 1e-6);
        EXPECT_EQ(g.observer.size(), 120u);
    }
}

TEST(GroupDPrime, OfObserversBelowChanceIsNotAboveZero)
{
    // 20 observers with 31.5 % right of three: every one cut off at 0 would give 0.355 [0.127, 0.584].
    std::vector<DetectionCounts> people;
    for (int i = 0; i < 20; ++i) people.push_back({double(5 + (7 * i) % 10), 30, 0, 0});
    GroupDPrime const g = group_dprime(DetectionTask::oddity, people);
    EXPECT_LT(g.mean, 0);
    EXPECT_LT(g.interval.low, 0);
    EXPECT_GT(g.interval.high, 0);
}

TEST(GroupDPrime, OfOneObserverIsThatOfTheRates)
{
    std::vector<DetectionCounts> const one{{20, 25, 10, 25}};
    GroupDPrime const g = group_dprime(DetectionTask::yes_no, one);
    EXPECT_NEAR(g.mean, 1.094968, 1e-3);
    EXPECT_NEAR(g.criterion, -0.294137, 1e-3);
    double const error = yes_no(20, 25, 10, 25).standard_error;
    EXPECT_NEAR((g.interval.high - g.interval.low) / (2 * 1.96 * error), 1, 0.05);
}

TEST(GroupDPrime, OfPerfectObserversHasNoUpperLimit)
{
    std::vector<DetectionCounts> const people(6, {10, 10, 0, 0});
    GroupDPrime const g = group_dprime(DetectionTask::oddity, people);
    EXPECT_TRUE(std::isinf(g.mean));
    EXPECT_GT(g.interval.low, 2);
    EXPECT_TRUE(std::isinf(g.interval.high));
    EXPECT_NE(g.note.find("no upper limit"), std::string::npos);
    auto const yes_no = [](double hits, double false_alarms) {
        return group_dprime(DetectionTask::yes_no, std::vector<DetectionCounts>{{hits, 20, false_alarms, 20},
                                                                                {hits, 20, false_alarms, 20}});
    };
    EXPECT_EQ(yes_no(20, 10).mean, INFINITY) << "no signal was missed";
    EXPECT_EQ(yes_no(11, 0).mean, INFINITY) << "no false alarm";
    EXPECT_EQ(yes_no(0, 9).mean, -INFINITY);
    EXPECT_NE(yes_no(0, 9).note.find("no lower limit"), std::string::npos);
    EXPECT_TRUE(std::isfinite(yes_no(20, 20).mean)) << "always yes";
    EXPECT_THROW(group_dprime(DetectionTask::oddity, {}), std::invalid_argument);
    EXPECT_THROW(group_dprime(DetectionTask::yes_no, std::vector<DetectionCounts>{{3, 4, 0, 0}}),
                 std::invalid_argument);
}

TEST(GroupDPrime, OfEqualObserversHasThePOfObserversWhoMayDifferAtZero)
{
    // Expected p: numerical integration over observers, with the deviation that is most likely at d' = 0.
    auto const observers = [](std::vector<int> const& right) {
        std::vector<DetectionCounts> counts;
        for (int const r : right) counts.push_back({r / 2.0, 30, (60 - r) / 2.0, 30});
        return counts;
    };
    auto const middle = observers({37, 44, 40, 41, 45, 45, 37}), easy = observers({58, 57, 55, 53, 57, 57, 53});
    double const p = group_dprime(DetectionTask::two_interval, middle).p;
    EXPECT_NEAR(p, 2.2e-4, 0.1e-4);
    EXPECT_NEAR(group_dprime(DetectionTask::two_interval, easy).p, 4.5e-6, 0.1e-6);
    EXPECT_EQ(group_dprime(DetectionTask::two_interval, middle, 0.8).p, p) << "of another confidence";
    auto const just = group_dprime(DetectionTask::two_interval, middle, 1 - p);
    EXPECT_NEAR(just.interval.low, 0, 5e-3) << "the interval that p belongs to ends at 0";
}

TEST(GroupDPrime, OfOnlyRightAnswersIsInfiniteForOneObserverToo)
{
    GroupDPrime const g = group_dprime(DetectionTask::two_interval, std::vector<DetectionCounts>{{10, 10, 0, 10}});
    EXPECT_EQ(g.mean, INFINITY);
    EXPECT_NE(g.note, "");
    EXPECT_EQ(group_dprime(DetectionTask::two_interval, std::vector<DetectionCounts>{{0, 10, 10, 10}}).mean,
              -INFINITY);
}

TEST(GroupDPrime, HoldsTheDeviationBetweenObserversAsOftenAsItSays)
{
    for (double const deviation : {0.05, 0.6})
        for (DetectionTask const task : {DetectionTask::yes_no, DetectionTask::two_interval}) {
            int held = 0;
            constexpr int kStudies = 100;
            for (int i = 0; i < kStudies; ++i) {
                Interval const found =
                    group_dprime(task, simulated(task, 1.2, deviation, 8, 80, std::uint64_t(700 + i)))
                        .deviation_interval;
                held += found.low <= deviation && deviation <= found.high;
            }
            EXPECT_GE(held, 90) << deviation << " " << int(task);
        }
    auto const people = simulated(DetectionTask::yes_no, 1.2, 0.6, 8, 80, 7);
    EXPECT_TRUE(std::isnan(group_dprime(DetectionTask::yes_no, people, 0.95, false).deviation_interval.low));
    EXPECT_TRUE(
        std::isnan(group_dprime(DetectionTask::yes_no, std::span(people).first(1)).deviation_interval.high));
}

} // namespace
} // namespace study::test
