// A small version of the simulations in docs/performance.md: do intervals of `analyze` hold?

#include "tests/study_analysis/coverage.h"

#include <gtest/gtest.h>

namespace study::test {
namespace {

TEST(Coverage, OfObserversWithoutSensitivityIntervalsHoldZero)
{
    AnalysisSettings settings;
    settings.draws = 0;
    settings.replicates = 100; // of bootstraps, which are not looked at
    for (DetectionTask const task : {DetectionTask::oddity, DetectionTask::same_different, DetectionTask::abx}) {
        Tally tally;
        for (std::uint64_t i = 0; i < 12; ++i) {
            DetectionExperiment e;
            e.task = task;
            Analysis const a = analyse_detection(e, i, settings);
            DetectionResult const& d = a.blocks.at(0).detections.at(0);
            EXPECT_EQ(d.observers, 20);
            EXPECT_EQ(d.trials, 600);
            tally.add(d.observer_dprime.value, d.observer_dprime.interval, 0);
        }
        // Of 12 intervals of 95 %, more than 2 miss in 2 % of all simulations.
        EXPECT_GE(tally.covered, 10) << name_of(task);
        EXPECT_NEAR(tally.bias(), 0, 0.25) << name_of(task);
    }
}

TEST(Coverage, OfThresholdsOfEachMethodIsNotBiased)
{
    AnalysisSettings settings;
    settings.draws = 0;
    settings.replicates = 100; // of bootstraps, which are not looked at
    for (char const* const method : {"constant", "staircase", "questplus"}) {
        ThresholdExperiment e;
        e.method = method;
        Tally group, own;
        for (std::uint64_t i = 0; i < 4; ++i) {
            SimulatedThresholds const s = analyse_thresholds(e, i, settings);
            BlockResult const& b = s.analysis.blocks.at(0);
            for (ThresholdSummary const& t : b.thresholds) {
                if (t.method != "likelihood" || std::abs(t.proportion - s.share) > 1e-9) continue;
                EXPECT_EQ(t.level.n, 20);
                group.add(std::log10(t.level.value),
                          {std::log10(t.level.interval.low), std::log10(t.level.interval.high)}, kMeanThreshold);
            }
            for (std::size_t k = 0; k < b.runs.size(); ++k)
                for (ThresholdEstimate const& t : b.runs[k].estimates)
                    if (t.method == "likelihood" && std::abs(t.proportion - s.share) < 1e-9)
                        own.add(std::log10(t.level.value),
                                {std::log10(t.level.interval.low), std::log10(t.level.interval.high)}, s.own[k]);
        }
        EXPECT_EQ(group.experiments, 4) << method;
        EXPECT_EQ(own.experiments, 80) << method;
        EXPECT_GE(group.covered, 3) << method;
        EXPECT_NEAR(group.bias(), 0, 0.05) << method; // decades
        EXPECT_GE(own.coverage(), 90) << method;
        EXPECT_NEAR(own.bias(), 0, 0.06) << method;
    }
}

TEST(Hierarchical, ModelsOfAnAnalysisConvergeAndHoldMostObservers)
{
    AnalysisSettings settings;
    settings.draws = 300;
    DetectionExperiment e;
    e.task = DetectionTask::abx;
    e.mean = 1.5;
    e.sd = 0.4;
    std::vector<double> own;
    Analysis const a = analyse_detection(e, 3, settings, &own);
    ASSERT_EQ(a.blocks.at(0).hierarchical.size(), 1u);
    HierarchicalResult const& h = a.blocks[0].hierarchical[0];
    EXPECT_EQ(h.refused, "");
    EXPECT_EQ(h.each.size(), 20u);
    EXPECT_EQ(h.report.draws, 1200);
    EXPECT_LT(h.report.worst_r_hat, 1.05);
    EXPECT_LE(h.report.divergences, 3);
    EXPECT_LT(h.mean.interval.low, 1.5);
    EXPECT_GT(h.mean.interval.high, 1.5);
    int held = 0;
    for (std::size_t i = 0; i < own.size(); ++i)
        held += h.each[i].interval.low <= own[i] && own[i] <= h.each[i].interval.high;
    EXPECT_GE(held, 16);
    Analysis const again = analyse_detection(e, 3, settings);
    EXPECT_EQ(again.blocks[0].hierarchical[0].mean.value, h.mean.value);
}

} // namespace
} // namespace study::test
