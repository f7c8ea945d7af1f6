#include "study/adaptive/staircase.h"
#include "study/analysis/groups.h"
#include "study/analysis/result_tables.h"
#include "study/numeric/random.h"
#include "study/stats/ratings.h"
#include "study/tables/export.h"
#include "tests/study_analysis/made_sessions.h"

#include <algorithm>
#include <cmath>

namespace study::test {
namespace {

Script pairs_script(std::string const& more = "")
{
    return parse_script(R"(schema: study/1
id: p
seed: 1
participants: {count: 4}
factors: {scene: [hall, yard], method: [exact, good, bad]}
reference: {method: exact}
defaults: {stimulus_ms: 2000}
sequence: [which]
blocks:
  which: {task: pair, pairs: {factor: method}, cross: [scene]}
)" + more,
                        "p.yaml");
}

/// Always the better one of exact > good > bad; one who errs takes `bad` over `good` now and then.
std::vector<RecordedSession> sessions_of(Script const& s, int people, int who_errs = -1)
{
    std::vector<RecordedSession> out;
    for (int p = 1; p <= people; ++p) {
        int trials = 0;
        out.push_back(record_session(s, p, [&](PlanStep const& step, TrialDone& done) {
            char const first = step.trial.order[0], second = step.trial.order[1];
            int const a = stimulus_of(step.trial, first)->levels[1],
                      b = stimulus_of(step.trial, second)->levels[1];
            bool const errs = (p == who_errs || ++trials % 3 == 0) && a + b == 3;
            done.response = (a < b) != errs ? "first" : "second";
            for (StimulusShown& shown : done.shown)
                shown.render_ms_mean = 10 - 3 * stimulus_of(step.trial, shown.letter)->levels[1];
        }));
    }
    return out;
}

TEST(Analysis, OfNobodyIsEmptyAndSaysSo)
{
    Analysis const a = analyze(pairs_script(), {});
    EXPECT_TRUE(a.blocks.empty());
    ASSERT_FALSE(a.cautions.empty());
    EXPECT_EQ(a.cautions[0], "nobody is left to analyse");
}

TEST(Analysis, OfOneObserverHasNoIntervalOverObservers)
{
    Script const s = pairs_script();
    Analysis const a = analyze(s, sessions_of(s, 1));
    ScaleResult const& all = a.blocks.at(0).scales.at(0);
    EXPECT_EQ(all.refused, "");
    EXPECT_GT(all.items[0].score.value, all.items[2].score.value);
    ASSERT_FALSE(all.notes.empty());
    EXPECT_NE(all.notes[0].find("as if all trials were of different people"), std::string::npos);
    EXPECT_TRUE(a.observers.at(0).outlier_score.empty());
}

TEST(Analysis, OfASessionThatWasCutOffTakesWhatIsThere)
{
    Script const s = pairs_script();
    auto sessions = sessions_of(s, 3);
    auto& entries = sessions[1].record.entries;
    entries.resize(4); // start, calibration, two trials
    Analysis const a = analyze(s, sessions);
    EXPECT_EQ(a.complete, 2);
    EXPECT_EQ(a.observers.at(1).counted, 2);
    ASSERT_FALSE(a.exclusions.empty());
    EXPECT_EQ(a.exclusions[0].why, "the session is not complete");
    for (AgreementResult const& cell : a.blocks.at(0).agreement) EXPECT_EQ(cell.observers, 2) << cell.cell;
    EXPECT_EQ(a.blocks.at(0).agreement.front().left_out + a.blocks.at(0).agreement.back().left_out, 2);
    entries.resize(1); // no trial at all
    EXPECT_EQ(analyze(s, sessions).observers.at(1).counted, 0);
}

TEST(Analysis, LeavesOutInvalidTrialsAndSaysWhy)
{
    Script const s = pairs_script();
    auto sessions = sessions_of(s, 2);
    auto& done = std::get<TrialDone>(sessions[0].record.entries.at(2));
    done.is_valid = false;
    done.reason = "dropped_frames";
    Analysis const a = analyze(s, sessions);
    EXPECT_EQ(a.blocks.at(0).scales.at(0).observations, 11);
    ASSERT_EQ(a.exclusions.size(), 1u);
    EXPECT_EQ(a.exclusions[0].why, "invalid: dropped_frames");
    EXPECT_EQ(a.exclusions[0].trials, 1);

    Script const keeps = pairs_script("timing: {on_bad_trial: keep}\n");
    Analysis const kept = analyze(keeps, sessions);
    EXPECT_EQ(kept.blocks.at(0).scales.at(0).observations, 12);
    EXPECT_EQ(kept.exclusions.at(0).what, "kept");
}

TEST(Analysis, FindsNoCircularTriadsInConsistentChoices)
{
    Script const s = pairs_script();
    Analysis const a = analyze(s, sessions_of(s, 4));
    for (ObserverSummary const& o : a.observers) {
        EXPECT_EQ(o.triads, 0);
        EXPECT_EQ(o.most_triads, 2) << "one triad in each of two scenes";
        EXPECT_EQ(o.zeta, 1);
    }
}

TEST(Analysis, NamesTheCheapestThatIsNotToldFromTheReference)
{
    // good against exact: even; bad: always worse. Cost falls from exact to bad.
    Script const s = pairs_script();
    std::vector<RecordedSession> sessions;
    for (int p = 1; p <= 12; ++p) {
        MadeSession made(s, "P" + std::to_string(p));
        for (int scene = 0; scene < 2; ++scene) {
            auto const add = [&](int a, int b, bool first) {
                TrialDone& t = made.add(0, {{scene, a}, {scene, b}}, first ? "first" : "second");
                t.shown[0].render_ms_mean = 10 - 3 * a;
                t.shown[1].render_ms_mean = 10 - 3 * b;
            };
            add(0, 1, (p + scene) % 2 == 0);
            add(0, 2, (p + 3 * scene) % 12 != 0);
            add(1, 2, (p + 5 * scene) % 12 != 3);
        }
        sessions.push_back(made.finished());
    }
    ScaleResult const all = analyze(s, sessions).blocks.at(0).scales.at(0);
    ASSERT_TRUE(all.cheapest);
    EXPECT_TRUE(all.cheapest->is_reference);
    EXPECT_EQ(all.items[std::size_t(all.cheapest->against)].name, "exact");
    EXPECT_EQ(all.items[std::size_t(all.cheapest->item)].name, "good");
    EXPECT_DOUBLE_EQ(all.items[1].render_ms.value, 7);
    EXPECT_LT(all.differences[1].p_holm, 0.05) << "exact against bad";
}

TEST(Analysis, ReplaysStaircasesAndEstimatesTheirThresholdThreeWays)
{
    Script const s = parse_script(R"(schema: study/1
id: s
seed: 1
participants: {count: 2}
factors: {scene: [hall]}
reference: {scene: hall}
defaults: {stimulus_ms: 2000}
sequence: [find]
blocks:
  find:
    task: 2ifc
    cross: [scene]
    compare: {vary: points, against: reference, scale: log2, range: [64, 16384], harder: up}
    interleave:
      - {name: d2, method: staircase, up: 1, down: 2, start: 256, steps: [2, 1, 0.5], stop: {reversals: 12, max_trials: 60}}
      - {name: qp, method: questplus, threshold: 64..16384/33, slope: [1, 2, 3.5, 5], guess: 0.5, lapse: [0, 0.02, 0.04], stop: {trials: 40}}
)",
                                  "s.yaml");
    std::vector<RecordedSession> sessions;
    for (int p = 1; p <= 2; ++p) {
        Random random = Random::part(7, std::uint64_t(p));
        StaircaseSettings rule;
        rule.start = -8;
        rule.steps = {2, 1, 0.5};
        rule.initial = InitialRule::none;
        rule.low = -14;
        rule.high = -6;
        rule.stop = {12, 0, 60};
        Staircase staircase(rule);
        MadeSession made(s, p == 1 ? "P001" : "P002");
        auto const answer = [&](double level, int procedure) {
            // 75 % at 1024, Weibull of slope 3.
            double const share = 0.5 + 0.5 * (1 - std::exp(-std::log(2.0) * std::pow(1024 / level, 3)));
            bool const right = random.uniform() < share;
            TrialDone& t = made.add(0, {{0}, {0}}, right ? "first" : "second");
            t.level = level;
            t.is_correct = right;
            made.last_step().trial.procedure = procedure;
            return right;
        };
        while (!staircase.finished()) staircase.respond(answer(std::exp2(-staircase.level()), 0));
        for (int i = 0; i < 40; ++i) answer(std::exp2(6 + 0.25 * (10 + i % 13)), 1);
        sessions.push_back(made.finished());
    }
    BlockResult const b = analyze(s, sessions).blocks.at(0);
    ASSERT_EQ(b.runs.size(), 4u);
    EXPECT_EQ(b.runs[0].reversals.size(), 12u);
    ASSERT_EQ(b.runs[0].estimates.size(), 3u);
    EXPECT_EQ(b.runs[0].estimates[0].method, "mean of reversals");
    EXPECT_NEAR(b.runs[0].estimates[0].proportion, std::sqrt(0.5), 1e-9);
    ASSERT_EQ(b.runs[1].estimates.size(), 2u);
    EXPECT_EQ(b.runs[1].estimates[1].method, "QUEST+ posterior");
    for (ThresholdSummary const& t : b.thresholds) {
        EXPECT_EQ(t.level.n, 2) << t.method;
        EXPECT_NEAR(std::log2(t.level.value), 10, 0.8) << t.procedure << ", " << t.method;
    }
    ASSERT_EQ(b.curves.size(), 1u);
    EXPECT_NEAR(std::log2(b.curves[0].threshold.value), 10, 0.5);
    EXPECT_LT(b.curves[0].threshold.interval.low, b.curves[0].threshold.value);
}

/// Yes or no at levels 1 to 100, `harder: down`; false alarms in a fifth of 50 trials without a signal.
BlockResult yes_no_block(std::string const& procedure)
{
    Script const s = yes_no_script("down", procedure);
    MadeSession made(s, "P001");
    for (double const level : {1.0, 3.16227766, 10.0, 31.6227766, 100.0})
        for (int i = 0; i < 50; ++i) {
            double const share = 0.2 + 0.78 * (1 - std::exp(-std::pow(level / 10, 1.5)));
            made.add_yes_no(level, i < 50 * share, false);
        }
    for (int i = 0; i < 50; ++i) made.add_yes_no(1, i % 5 == 0, true);
    return analyze(s, {made.finished()}).blocks.at(0);
}

TEST(Analysis, OfARunOfYesAndNoKnowsItsFalseAlarms)
{
    BlockResult const b =
        yes_no_block("{method: constant, levels: [1, 3.16227766, 10, 31.6227766, 100], trials_per_level: 100}");
    ASSERT_EQ(b.runs.size(), 1u);
    ThresholdEstimate const& e = b.runs[0].estimates.at(0);
    EXPECT_EQ(e.note, "");
    // Where 0.2 + 0.78 (1 - exp(-(level / 10)^1.5)) is a half.
    double const level = 10 * std::pow(-std::log(1 - 0.3 / 0.78), 1 / 1.5);
    EXPECT_NEAR(std::log10(e.level.value), std::log10(level), 0.05);
}

TEST(Analysis, OfQuestPlusThatNeverReachesItsShareSaysSo)
{
    auto const estimate = [](char const* guess) {
        auto const b =
            yes_no_block(std::string("{method: questplus, threshold: 1..100/21, slope: [1, 2], guess: ") + guess +
                         ", lapse: 0.02, stop: {trials: 300}}");
        return b.runs.at(0).estimates.at(1);
    };
    EXPECT_EQ(estimate("0.5").method, "QUEST+ posterior");
    EXPECT_TRUE(std::isnan(estimate("0.5").level.value));
    EXPECT_EQ(estimate("0.5").note, "most functions of the posterior never reach this proportion");
    EXPECT_EQ(estimate("0.2").note, "");
    EXPECT_NEAR(std::log10(estimate("0.2").level.value), std::log10(6), 0.15);
}

TEST(Analysis, OfQuestPlusKnowsThatSlopesMoveTheLevelOfAShare)
{
    // The share of the grid's threshold is 1 - 1/e of what guesses and lapses leave; slopes that differ move the
    // level of another share, on which the answers at that threshold tell nothing.
    auto const width = [](char const* slopes) {
        Interval const i =
            yes_no_block(std::string("{method: questplus, threshold: 9.9..10.1/3, slope: ") + slopes +
                         ", guess: 0.2, lapse: 0.02, levels: [10, 10.1], stop: {trials: 300}}")
                .runs.at(0)
                .estimates.at(1)
                .level.interval;
        return std::log10(i.high / i.low);
    };
    EXPECT_LT(width("1"), 0.02);
    EXPECT_GT(width("[0.5, 1, 2]"), 0.2);
}

TEST(Analysis, OfDetectionInPairsHasARowForEachPair)
{
    Script const s = parse_script(R"(schema: study/1
id: p
seed: 1
participants: {count: 4}
factors: {quality: [low, middle, high]}
reference: {quality: low}
defaults: {stimulus_ms: 200}
sequence: [odd]
blocks:
  odd: {task: oddity, pairs: {factor: quality}, repeats: 6}
)",
                                  "p.yaml");
    std::vector<RecordedSession> sessions;
    for (int p = 1; p <= 3; ++p) {
        int trials = 0;
        sessions.push_back(record_session(s, p, [&](PlanStep const& step, TrialDone& done) {
            bool const is_hard =
                stimulus_of(step.trial, 'a')->levels[0] == 0 && stimulus_of(step.trial, 'b')->levels[0] == 1;
            done.response = "first";
            done.is_correct = !is_hard || ++trials <= p; // 1, 2 and 3 of 6
        }));
    }
    AnalysisSettings settings;
    settings.draws = 0;
    Analysis const a = analyze(s, sessions, settings);
    auto const& rows = a.blocks.at(0).detections;
    ASSERT_EQ(rows.size(), 3u);
    for (DetectionResult const& row : rows)
        EXPECT_NEAR(row.correct / row.trials, row.condition == "low vs middle" ? 1 / 3.0 : 1, 1e-9)
            << row.condition;
    ASSERT_FALSE(a.effects.empty());
    EXPECT_EQ(a.effects[0].test.df1, 2) << "effect of three pairs";
    EXPECT_NE(lme4_script(s, "t.csv").find("paste(d$cond_a, \"vs\", d$cond_b)"), std::string::npos);
    EXPECT_NE(statsmodels_script(s, "t.csv").find("+ \" vs \" + d[\"cond_b\"]"), std::string::npos);
}

Script rating_script(std::string const& items)
{
    return parse_script("schema: study/1\nid: r\nseed: 1\nparticipants: {count: 8}\nfactors: {asset: [" + items +
                            "]}\nsequence: [rate]\nblocks: {rate: {task: rating, cross: [asset], "
                            "scale: {min: 1, max: 5}}}\n",
                        "r.yaml");
}

/// Eight observers rate each item twice.
std::vector<RecordedSession> rated_twice(Script const& script, int items, std::vector<Rating>& ratings)
{
    Random random(4);
    std::vector<RecordedSession> sessions;
    for (int o = 0; o < 8; ++o) {
        MadeSession s(script, "P" + std::to_string(o));
        for (int k = 0; k < 2 * items; ++k) {
            double const value = std::clamp(std::round(1 + k % items + 0.8 * random.normal()), 1.0, 5.0);
            s.add(0, {{k % items}}, "", value);
            ratings.push_back({k % items, o, value});
        }
        sessions.push_back(s.finished());
    }
    return sessions;
}

TEST(Analysis, OfRepeatedRatingsFitsTheModelOfRatersToSingleOnes)
{
    Script const script = rating_script("a, b, c, d");
    std::vector<Rating> ratings;
    auto const sessions = rated_twice(script, 4, ratings);
    Analysis const a = analyze(script, sessions);
    ScaleResult const& all = a.blocks.at(0).scales.at(0);
    RatingModel const model = fit_ratings(ratings, 4, 8);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(fact(all, "allowing for bias and inconsistency " + all.items[i].name), model.quality[i], 1e-8);
}

TEST(Analysis, OfOneRatedItemHasNeitherModelNorFriedmansTestNorRemarks)
{
    Script const script = rating_script("a");
    std::vector<Rating> ratings;
    auto const sessions = rated_twice(script, 1, ratings);
    Analysis const a = analyze(script, sessions);
    ScaleResult const& all = a.blocks.at(0).scales.at(0);
    EXPECT_EQ(all.items.size(), 1u);
    EXPECT_TRUE(all.facts.empty());
    EXPECT_TRUE(all.notes.empty());
}

TEST(Analysis, TellsHowMuchOfAModelIsDrawn)
{
    Script const s = pairs_script();
    AnalysisSettings settings;
    settings.has_hierarchy = true;
    settings.draws = 20;
    std::map<std::string, double> drawn;
    settings.progress = [&](std::string const& what, double share) { drawn[what] = share; };
    analyze(s, sessions_of(s, 3), settings);
    EXPECT_EQ(drawn, (std::map<std::string, double>{
                         {"scores, all", 1}, {"scores, scene=hall", 1}, {"scores, scene=yard", 1}}));
}

TEST(ResultTables, HaveNoRoundingInPlaceOfZero)
{
    Analysis a;
    ScaleResult scale;
    scale.items = {{"a", {0.5, {-1.646e-16, 1}, 3}, {}}, {"b", {1e-17, {-2e-17, 3e-17}, 3}, {}}};
    a.blocks.emplace_back();
    a.blocks[0].scales = {scale};
    for (ResultTable const& t : result_tables(a)) {
        if (t.name != "scores") continue;
        ASSERT_EQ(t.table.rows.size(), 2u);
        EXPECT_EQ(t.table.rows[0].at(5), "0");
        EXPECT_EQ(t.table.rows[0].at(4), "0.5");
        for (std::size_t c : {4, 5, 6}) EXPECT_EQ(t.table.rows[1].at(c), "0");
    }
}

TEST(Holm, RaisesSmallPValuesMost)
{
    auto const p = holm({0.01, 0.04, kUnknown, 0.03});
    EXPECT_DOUBLE_EQ(p[0], 0.03);
    EXPECT_DOUBLE_EQ(p[1], 0.06);
    EXPECT_DOUBLE_EQ(p[3], 0.06);
    EXPECT_TRUE(std::isnan(p[2]));
}

TEST(MeanOf, HasStudentsInterval)
{
    Uncertain const u = mean_of({1, 2, 3, kUnknown}, 0.95);
    EXPECT_EQ(u.n, 3);
    EXPECT_DOUBLE_EQ(u.value, 2);
    EXPECT_NEAR(u.interval.high - 2, 2.484138, 1e-5); // t(0.975, 2) / sqrt 3
    EXPECT_TRUE(std::isnan(mean_of({5}, 0.95).interval.low));
}

TEST(MeanOf, ValuesThatDoNotVaryHasNoIntervalAndNoTest)
{
    // 20.1 - 10.1 and 30.3 - 20.3 are 10 but for rounding.
    for (double const size : {1e-12, 1.0, 1e12}) {
        std::vector<double> const values{size * 20.1 - size * 10.1, size * 10, size * 30.3 - size * 20.3};
        Uncertain const u = mean_of(values, 0.95, size * 30.3);
        EXPECT_TRUE(u.is_constant);
        EXPECT_NEAR(u.value / size, 10, 1e-9);
        EXPECT_TRUE(std::isnan(u.interval.low) && std::isnan(u.interval.high));
        EXPECT_TRUE(std::isnan(mean_p(values, size * 30.3)));
    }
    Uncertain const nothing = mean_of({0.1 + 0.2 - 0.3, 0}, 0.95, 0.3);
    EXPECT_TRUE(nothing.is_constant);
    EXPECT_EQ(nothing.value, 0);
    EXPECT_TRUE(std::isnan(mean_p({2, 2})));
    EXPECT_LT(mean_p({1e9, 1e9 + 1, 1e9 + 2}), 1e-9);
}

} // namespace
} // namespace study::test
