// The threshold of a run by QUEST+'s posterior. Runs without trials have the prior,
// which is uniform over the grids.

#include "study/analysis/result_tables.h"
#include "study/analysis/threshold_run.h"
#include "study/script/procedure_settings.h"
#include "tests/study_analysis/made_sessions.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <string>

namespace study::test {
namespace {

/// The level of 55 % by a run without trials, whose posterior is the prior: uniform over the grids.
ThresholdEstimate prior_estimate(std::string const& settings, std::string const& harder = "down",
                                 double confidence = 0.95)
{
    Script const s =
        yes_no_script(harder, "{method: questplus, levels: 1..100/5, " + settings + ", stop: {trials: 40}}");
    AnalysisSettings a;
    a.confidence = confidence;
    Block const& b = s.blocks.at(0);
    return questplus_estimate({}, b, b.procedures.at(0), 0.55, a);
}

TEST(QuestPlusEstimate, SaysWhereItsIntervalIsOpen)
{
    // A quarter of the functions starts above 55 %, or ends below it.
    std::string const starts = "threshold: 5..20/9, slope: 2, guess: [0.1, 0.15, 0.2, 0.6], lapse: 0.02";
    std::string const ends = "threshold: 5..20/9, slope: 2, guess: 0.2, lapse: [0, 0.02, 0.04, 0.5]";
    std::string const why =
        ": more than 2.5 % of the posterior's functions reach this proportion beyond all levels or never";
    ThresholdEstimate const low = prior_estimate(starts), high = prior_estimate(ends);
    for (ThresholdEstimate const& e : {low, high}) {
        EXPECT_GT(e.level.value, 3);
        EXPECT_LT(e.level.value, 20);
    }
    EXPECT_TRUE(std::isnan(low.level.interval.low));
    EXPECT_TRUE(std::isfinite(low.level.interval.high));
    EXPECT_EQ(low.note, "the interval is open below" + why);
    EXPECT_TRUE(std::isfinite(high.level.interval.low));
    EXPECT_TRUE(std::isnan(high.level.interval.high));
    EXPECT_EQ(high.note, "the interval is open above" + why);
    // Where higher levels are harder, functions that start above 55 % go below it above all levels.
    EXPECT_EQ(prior_estimate(starts, "up").note, "the interval is open above" + why);
    EXPECT_EQ(prior_estimate("threshold: 5..20/9, slope: 2, guess: [0.1, 0.15, 0.2], lapse: 0.02").note, "");
}

/// Answers of somebody whose threshold is at this level, without errors, at levels around it.
ThresholdRun run_around(double threshold)
{
    ThresholdRun run;
    for (int i = 0; i < 40; ++i) {
        run.levels.push_back(std::pow(10.0, 0.5 * (i % 5)));
        run.correct.push_back(run.levels.back() >= threshold);
    }
    return run;
}

TEST(QuestPlusEstimate, SaysWhereItsPriorCutsIt)
{
    auto const note = [](double threshold, std::string const& prior, std::string const& harder = "down") {
        Script const s = yes_no_script(harder, "{method: questplus, levels: 1..100/5, threshold: " + prior +
                                                   ", slope: 3, guess: 0.1, lapse: 0.02, stop: {trials: 40}}");
        Block const& b = s.blocks.at(0);
        ThresholdRun run = run_around(threshold);
        if (harder == "up")
            for (int& c : run.correct) c = 1 - c;
        ThresholdEstimate const e = questplus_estimate(run, b, b.procedures.at(0), 0.55, {});
        EXPECT_EQ(e.note.find(e.doubt) == std::string::npos, false);
        return e.doubt;
    };
    std::string const why = " end of the prior of the threshold, 30 to 60: the threshold may lie beyond";
    EXPECT_EQ(note(5, "30..60/10"), "the posterior is cut at the lower" + why);
    EXPECT_EQ(note(5, "30..60/10", "up"), "the posterior is cut at the lower" + why);
    EXPECT_EQ(note(5, "1..3/10"),
              "the posterior is cut at the upper end of the prior of the threshold, 1 to 3: the threshold "
              "may lie beyond");
    EXPECT_EQ(note(5, "1..100/20"), "");
}

TEST(ThresholdEstimates, BeyondAllLevelsShownAreNamedAndCounted)
{
    ThresholdRun run;
    run.levels = {0.2, 0.1, 0.4};
    struct Case {
        double level;
        char const* doubt;
    };
    for (Case const& c : {Case{0.05, "the threshold lies below all levels shown"},
                          {0.1, ""},
                          {0.25, ""},
                          {0.4, ""},
                          {0.5, "the threshold lies above all levels shown"},
                          {kUnknown, ""}}) {
        ThresholdEstimate e{"likelihood", 0.75, {c.level}, "a note"};
        note_outside(run, e);
        EXPECT_EQ(e.doubt, c.doubt);
        EXPECT_EQ(e.note, *c.doubt == '\0' ? "a note" : "a note; " + std::string(c.doubt) + ", 0.1 to 0.4");
    }
    EXPECT_EQ(cut_end({0.1, 0.3, 0.6}), "upper");
    EXPECT_EQ(cut_end({0.6, 0.3, 0.1}), "lower");
    EXPECT_EQ(cut_end({0.1, 0.3, 0.1}), "");
    EXPECT_EQ(cut_end({1}), "");

    // Three people who hear everything that is shown, of a range that has softer sounds, and one who does not.
    Script const s = yes_no_script("down", "{method: constant, levels: 10..100/5, trials_per_level: 8}");
    std::vector<RecordedSession> sessions;
    for (int p = 1; p <= 3; ++p) {
        MadeSession made(s, "P00" + std::to_string(p));
        for (int k = 0; k < 5; ++k)
            for (int i = 0; i < 8; ++i) {
                made.add_yes_no(10 * std::pow(10.0, k / 4.0), i > 0 || k + p > 2, false);
                made.add_yes_no(10, i == 0, true);
            }
        sessions.push_back(made.finished());
    }
    AnalysisSettings settings;
    settings.draws = 0;
    Analysis const a = analyze(s, sessions, settings);
    EXPECT_NE(
        a.blocks.at(0).thresholds.at(0).note.find("the mean threshold lies below all levels shown, 10 to 100"),
        std::string::npos)
        << a.blocks[0].thresholds[0].note;
    std::string const text = to_text(a);
    EXPECT_NE(text.find("3 of 3 runs, likelihood at 50 %: the threshold lies below all levels shown"),
              std::string::npos)
        << text;
    EXPECT_NE(to_json(a).find("the threshold lies below all levels shown, 10 to 100"), std::string::npos);
}

TEST(QuestPlusEstimate, OfAPriorOfOnePointIsNone)
{
    ThresholdEstimate const e = prior_estimate("threshold: 10, slope: 2, guess: 0.2, lapse: 0.02");
    EXPECT_TRUE(std::isnan(e.level.value) && std::isnan(e.level.interval.low));
    EXPECT_EQ(e.note, "the prior has one point: nothing was learned");
    ThresholdEstimate const narrow = prior_estimate("threshold: 10, slope: 2, guess: 0.2, lapse: [0.02, 0.02001]");
    EXPECT_TRUE(std::isfinite(narrow.level.value));
}

TEST(QuestPlusEstimate, IsInfiniteForThePartThatIs)
{
    // A third of the functions starts above 55 %; quantiles of 0.3 and 0.35.
    std::string const starts = "threshold: [8, 12], slope: 2, guess: [0.1, 0.2, 0.6], lapse: 0.02";
    EXPECT_TRUE(std::isnan(prior_estimate(starts, "down", 0.4).level.interval.low));
    EXPECT_TRUE(std::isfinite(prior_estimate(starts, "down", 0.3).level.interval.low));
    // The same above; quantiles of 0.7 and 0.65.
    std::string const ends = "threshold: [8, 12], slope: 2, guess: 0.2, lapse: [0, 0.02, 0.5]";
    EXPECT_TRUE(std::isnan(prior_estimate(ends, "down", 0.4).level.interval.high));
    EXPECT_TRUE(std::isfinite(prior_estimate(ends, "down", 0.3).level.interval.high));
}

TEST(QuestPlusEstimate, KnowsOnWhichSideAFlatFunctionLies)
{
    // Steep functions that rise, or fall, far beyond the levels are equal at both ends of the search.
    for (std::string const harder : {"down", "up"}) {
        auto const note = [&](std::string const& place) {
            return prior_estimate("psychometric: 'guess + (1 - guess - lapse) * normal(slope * log10(" + place +
                                      "))', threshold: [1.5, 1.6, 1.7, 100], slope: 60, guess: 0.2, lapse: 0.02",
                                  harder)
                .note;
        };
        // The four functions have thresholds 5, 6.6, 8.4 and 1e8, or 10, 7.6, 6 and 5e-7.
        bool const rises = harder == "down";
        EXPECT_TRUE(
            note(rises ? "x / threshold^4" : "threshold^4 / x").starts_with("the interval is open above:"));
        EXPECT_TRUE(note(rises ? "x * threshold^4 / 50" : "50 / (x * threshold^4)")
                        .starts_with("the interval is open below:"));
    }
}

TEST(LikelihoodEstimate, SaysWhereItsIntervalIsOpen)
{
    // Without no-signal trials, the false alarm rate is unknown and may be above a half.
    auto const estimate = [](std::string const& harder) {
        Script const s = yes_no_script(harder, "{method: constant, levels: 1..100/5, trials_per_level: 2}");
        Block const& b = s.blocks.at(0);
        ThresholdRun run;
        run.levels = {1, 3.16227766, 10, 31.6227766, 100};
        run.correct = {0, 0, 1, 1, 1};
        if (harder == "up") std::reverse(run.correct.begin(), run.correct.end());
        return likelihood_estimate(run, b, fitted_function(b.procedures, b.compare->scale), {}, 0.5, {}, {});
    };
    std::string const why =
        "no trials without a signal: the false alarm rate is that of the fit; any threshold between ";
    ThresholdEstimate const rising = estimate("down"), falling = estimate("up");
    EXPECT_TRUE(std::isnan(rising.level.interval.low));
    EXPECT_GT(rising.level.interval.high, rising.level.value);
    EXPECT_TRUE(rising.note.starts_with(why + "3.16227766 and 10 fits")) << rising.note;
    EXPECT_NE(rising.note.find("; the interval is open below:"), std::string::npos) << rising.note;
    EXPECT_LT(falling.level.interval.low, falling.level.value);
    EXPECT_TRUE(std::isnan(falling.level.interval.high));
    EXPECT_TRUE(falling.note.starts_with(why + "10 and 31.6227766 fits")) << falling.note;
    EXPECT_NE(falling.note.find("; the interval is open above:"), std::string::npos) << falling.note;
}

TEST(GroupThresholds, SayWhereTheirIntervalIsOpen)
{
    // Three observers who hardly detect the easiest level, whose thresholds may lie far beyond it, or all of them.
    auto const block = [](std::string const& harder, bool detect) {
        Script const s = yes_no_script(harder, "{method: constant, levels: 1..100/5, trials_per_level: 5}");
        std::vector<RecordedSession> sessions;
        for (int p = 1; p <= 3; ++p) {
            MadeSession made(s, "P00" + std::to_string(p));
            for (int k = 0; k < 5; ++k)
                for (int i = 0; i < 5; ++i) {
                    double const level = std::pow(10.0, harder == "down" ? 0.5 * k : 2 - 0.5 * k);
                    int const right = detect ? 2 * k - 2 + (p == 2) : k == 4 ? 1 + (p == 2) : 0;
                    made.add_yes_no(level, i < right, false);
                    made.add_yes_no(level, i == 0, true);
                }
            sessions.push_back(made.finished());
        }
        AnalysisSettings settings;
        settings.draws = 0;
        return analyze(s, sessions, settings).blocks.at(0);
    };
    for (std::string const harder : {"down", "up"}) {
        std::string const side = harder == "down" ? "above" : "below";
        BlockResult const b = block(harder, false), known = block(harder, true);
        Interval const& interval = b.thresholds.at(0).level.interval;
        EXPECT_EQ(std::isnan(interval.low), harder == "up");
        EXPECT_EQ(std::isnan(interval.high), harder == "down");
        std::string const note =
            "the interval is open " + side + ": the answers do not exclude means far beyond all levels";
        EXPECT_NE(b.thresholds.at(0).note.find(note), std::string::npos) << b.thresholds.at(0).note;
        EXPECT_NE(b.curves.at(0).note.find(note), std::string::npos) << b.curves.at(0).note;
        EXPECT_EQ(known.thresholds.at(0).note.find("open"), std::string::npos) << known.thresholds.at(0).note;
    }
}

TEST(RunsTable, HasNullsForOpenEndsAndARemark)
{
    Analysis a;
    ThresholdRun run;
    run.estimates = {prior_estimate("threshold: 5..20/9, slope: 2, guess: [0.1, 0.15, 0.2, 0.6], lapse: 0.02")};
    a.blocks.emplace_back();
    a.blocks[0].runs = {run};
    auto const row = nlohmann::json::parse(to_json(a)).at("tables").at("runs").at(0);
    EXPECT_TRUE(row.at("low").is_null());
    EXPECT_TRUE(row.at("high").is_number());
    EXPECT_EQ(row.at("remark"), run.estimates[0].note);
}

} // namespace
} // namespace study::test
