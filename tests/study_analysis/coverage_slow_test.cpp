// As coverage_test.cpp, with enough experiments to tell 95 % from 90 %.

#include "tests/study_analysis/coverage.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace study::test {
namespace {

AnalysisSettings without_hierarchical()
{
    AnalysisSettings settings;
    settings.draws = 0;
    return settings;
}

TEST(CoverageOfManyStudies, OfDPrimeOfAllTasksIs92To98PerCent)
{
    for (double const mean : {0.0, 1.0})
        for (int k = 0; k < 5; ++k) {
            DetectionExperiment e;
            e.task = DetectionTask(k);
            e.mean = mean;
            e.sd = mean > 0 ? 0.3 : 0;
            Tally tally;
            for (std::uint64_t i = 0; i < 200; ++i) {
                Analysis const a = analyse_detection(e, 1000 + i, without_hierarchical());
                Uncertain const& d = a.blocks.at(0).detections.at(0).observer_dprime;
                tally.add(d.value, d.interval, mean);
            }
            RecordProperty(std::string(name_of(e.task)) + (mean > 0 ? "_1" : "_0"),
                           std::to_string(tally.coverage()));
            EXPECT_GE(tally.coverage(), 91) << name_of(e.task) << " " << mean;
            EXPECT_LE(tally.coverage(), 99) << name_of(e.task) << " " << mean;
            EXPECT_NEAR(tally.bias(), 0, 0.12) << name_of(e.task) << " " << mean;
        }
}

TEST(CoverageOfManyStudies, OfThresholdsOfEveryMethodIs90To99PerCent)
{
    for (char const* const method : {"constant", "staircase", "questplus"})
        for (double const lapse : {0.02, 0.05}) {
            ThresholdExperiment e;
            e.method = method;
            e.lapse = lapse;
            Tally group, own;
            for (std::uint64_t i = 0; i < 80; ++i) {
                SimulatedThresholds const s = analyse_thresholds(e, 1000 + i, without_hierarchical());
                BlockResult const& b = s.analysis.blocks.at(0);
                auto const add = [&](Tally& tally, Uncertain const& level, double truth) {
                    tally.add(std::log10(level.value),
                              {std::log10(level.interval.low), std::log10(level.interval.high)}, truth);
                };
                for (ThresholdSummary const& t : b.thresholds)
                    if (t.method == "likelihood" && std::abs(t.proportion - s.share) < 1e-9)
                        add(group, t.level, kMeanThreshold);
                for (std::size_t k = 0; k < b.runs.size(); ++k)
                    for (ThresholdEstimate const& t : b.runs[k].estimates)
                        if (t.method == "likelihood" && std::abs(t.proportion - s.share) < 1e-9)
                            add(own, t.level, s.own[k]);
            }
            RecordProperty(std::string(method) + (lapse > 0.03 ? "_5" : "_2"), std::to_string(group.coverage()));
            EXPECT_GE(group.coverage(), 88) << method << " " << lapse;
            EXPECT_NEAR(group.bias(), 0, 0.025) << method << " " << lapse;
            EXPECT_GE(own.coverage(), 91) << method << " " << lapse;
            EXPECT_LE(own.coverage(), 98) << method << " " << lapse;
        }
}

/// Of single runs, in decades.
Tally tally_of(ThresholdExperiment const& e, char const* method, std::vector<double> SimulatedThresholds::*truth)
{
    Tally own;
    for (std::uint64_t i = 0; i < 60; ++i) {
        SimulatedThresholds const s = analyse_thresholds(e, 2000 + i, without_hierarchical());
        auto const& runs = s.analysis.blocks.at(0).runs;
        for (std::size_t k = 0; k < runs.size(); ++k)
            for (ThresholdEstimate const& t : runs[k].estimates)
                if (t.method == method)
                    own.add(std::log10(t.level.value),
                            {std::log10(t.level.interval.low), std::log10(t.level.interval.high)}, (s.*truth)[k]);
    }
    return own;
}

TEST(CoverageOfManyStudies, OfMeansOfReversalsIs93To97PerCentAndMissesToBothSides)
{
    ThresholdExperiment e;
    e.method = "staircase";
    Tally const own = tally_of(e, "mean of reversals", &SimulatedThresholds::own_target);
    RecordProperty("coverage", std::to_string(own.coverage()));
    EXPECT_GE(own.coverage(), 93);
    EXPECT_LE(own.coverage(), 97);
    EXPECT_GE(3 * std::min(own.below, own.above), std::max(own.below, own.above));
}

TEST(CoverageOfManyStudies, OfQuestPlusWithManyLapsesIs94To97PerCentAndMissesToBothSides)
{
    ThresholdExperiment e;
    e.method = "questplus";
    e.lapse = 0.05;
    Tally const own = tally_of(e, "QUEST+ posterior", &SimulatedThresholds::own);
    RecordProperty("coverage", std::to_string(own.coverage()));
    EXPECT_GE(own.coverage(), 94);
    EXPECT_LE(own.coverage(), 97);
    EXPECT_GE(2 * std::min(own.below, own.above), std::max(own.below, own.above));
}

TEST(CoverageOfManyStudies, OfObserversByHierarchicalModelsIs93To97PerCent)
{
    DetectionExperiment e;
    e.task = DetectionTask::yes_no;
    e.mean = 1.5;
    e.sd = 0.4;
    Tally own;
    for (std::uint64_t i = 0; i < 100; ++i) {
        std::vector<double> truth;
        AnalysisSettings settings;
        settings.draws = 300;
        Analysis const a = analyse_detection(e, 3000 + i, settings, &truth);
        HierarchicalResult const& h = a.blocks.at(0).hierarchical.at(0);
        for (std::size_t k = 0; k < truth.size(); ++k) own.add(h.each[k].value, h.each[k].interval, truth[k]);
    }
    RecordProperty("coverage", std::to_string(own.coverage()));
    EXPECT_GE(own.coverage(), 93);
    EXPECT_LE(own.coverage(), 97);
}

} // namespace
} // namespace study::test
