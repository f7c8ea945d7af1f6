// Plans: the same from the same seed, balanced, counted, timed.

#include "study/plan/counterbalance.h"
#include "study/plan/doubts.h"
#include "study/plan/transitions.h"
#include "tests/study_design/samples.h"

#include <cmath>
#include <map>
#include <set>

namespace study::test {
namespace {

TEST(Plan, IsTheSameFromTheSameSeedAndDiffersOtherwise)
{
    for (char const* name : {"visibility2026", "pairs", "staircase", "rating"}) {
        std::string const text = example_text(name);
        Script const s = parse_script(text, name), again = parse_script(text, name);
        std::set<std::string> tables;
        for (int p = 1; p <= 12; ++p) {
            std::string const table = plan_table(s, make_plan(s, p));
            EXPECT_EQ(table, plan_table(again, make_plan(again, p)));
            EXPECT_TRUE(tables.insert(table).second) << name << ": two participants have one plan";
        }
        Script other = s;
        ++other.seed;
        EXPECT_NE(plan_table(other, make_plan(other, 1)), plan_table(s, make_plan(s, 1)));
    }
}

TEST(Plan, OfABlockDoesNotChangeWithOtherBlocks)
{
    std::string const one = "factors: {scene: [a, b, c]}\nsequence: [x, y]\nblocks:\n"
                            "  x: {task: rating, scale: {min: 1, max: 7}, cross: scene, repeats: 9}\n"
                            "  y: {task: rating, scale: {min: 1, max: 7}, cross: scene, repeats: ";
    Script const few = parse(one + "2}\n"), many = parse(one + "5}\n");
    auto const x = trials_of(make_plan(few, 1), Phase::main), y = trials_of(make_plan(many, 1), Phase::main);
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(x[i].stimuli, y[i].stimuli);
}

TEST(Plan, OfVisibility2026HasTheTrialsOfTheDesign)
{
    Script const s = parse_script(example_text("visibility2026"), "v");
    for (int p = 1; p <= 24; ++p) {
        Plan const plan = make_plan(s, p);
        std::size_t main = 0;
        for (int pass = 0; pass < 2; ++pass) {
            EXPECT_EQ(trials_of(plan, Phase::practice, 0, pass).size(), 4u);
            EXPECT_EQ(trials_of(plan, Phase::main, 0, pass).size(), 30u);
            EXPECT_EQ(trials_of(plan, Phase::main, 1, pass).size(), 18u);
            EXPECT_EQ(trials_of(plan, Phase::main, 2, pass).size(), 55u);
            EXPECT_EQ(trials_of(plan, Phase::catches, 2, pass).size(), 4u);
            for (int b = 0; b < 3; ++b) main += trials_of(plan, Phase::main, b, pass).size();
        }
        EXPECT_EQ(main, 206u);
        EXPECT_LT(plan.duration_us, 50LL * 60 * 1000000);
        EXPECT_GT(plan.duration_us, 35LL * 60 * 1000000);
        EXPECT_EQ(plan.participant_id, "P0" + std::string(p < 10 ? "0" : "") + std::to_string(p));
    }
}

TEST(Plan, OfTheGuideIsMade)
{
    std::string const file = LIGHTWELL_SOURCE_DIR "/../shared/guides/example_experiment.yaml";
    if (!std::ifstream(file)) GTEST_SKIP() << "there is no " << file;
    Script const s = parse_script(file_text(file), file);
    for (int p = 1; p <= s.participants.count; ++p) EXPECT_EQ(make_plan(s, p).steps.size(), 232u);
}

TEST(Counterbalance, CrossesDisplaysWithBlocks)
{
    Script const s = parse_script(example_text("visibility2026"), "v");
    EXPECT_EQ(full_cycle(s), 12);
    std::map<std::string, int> count;
    for (int p = 1; p <= 24; ++p) {
        std::string orders;
        for (PlanStep const& step : make_plan(s, p).steps)
            if (step.kind == PlanStepKind::trial && step.number == 1)
                orders += std::to_string(step.levels[2]) + std::to_string(step.block) + " ";
        ++count[orders];
    }
    EXPECT_EQ(count.size(), 12u); // 2 orders of displays x 6 of blocks
    for (auto const& [orders, n] : count) EXPECT_EQ(n, 2) << orders;
}

TEST(Counterbalance, AssignsLevelsBetweenParticipants)
{
    Script const s = parse_script(example_text("staircase"), "s");
    int const light = 2;
    ASSERT_EQ(s.factors[light].name, "light");
    std::map<int, int> count;
    for (int p = 1; p <= 10; ++p) {
        std::set<int> seen;
        for (PlanStep const& step : make_plan(s, p).steps)
            if (step.kind == PlanStepKind::trial) seen.insert(step.trial.stimuli[0].levels[light]);
        ASSERT_EQ(seen.size(), 1u);
        ++count[*seen.begin()];
    }
    EXPECT_EQ(count, (std::map<int, int>{{0, 5}, {1, 5}}));
}

TEST(Counterbalance, OfRandomOrdersUsesTheSeed)
{
    Random a(1), b(1);
    EXPECT_EQ(balanced_order(Balance::random, 9, 0, a), balanced_order(Balance::random, 9, 0, b));
    EXPECT_EQ(balanced_order(Balance::alternate, 3, 1, a), (std::vector<int>{2, 1, 0}));
    EXPECT_EQ(balanced_order(Balance::fixed, 3, 0, a), (std::vector<int>{0, 1, 2}));
}

/// first[i] - second[i] of each level over the trials.
std::map<int, int> surplus(std::vector<Trial> const& trials, std::size_t factor)
{
    std::map<int, int> out;
    for (Trial const& t : trials) {
        out[t.stimuli[std::size_t(t.order[0] - 'a')].levels[factor]] += 1;
        out[t.stimuli[std::size_t(t.order[1] - 'a')].levels[factor]] -= 1;
    }
    return out;
}

TEST(Pairs, ComeFirstAsOftenAsSecond)
{
    for (int levels = 2; levels <= 9; ++levels) {
        std::string names;
        for (int i = 0; i < levels; ++i) names += (i ? ", l" : "l") + std::to_string(i);
        std::string const body = "factors: {q: [" + names +
                                 "], scene: [a, b, c]}\nsequence: [x]\nblocks:\n"
                                 "  x: {task: pair, pairs: {factor: q}, cross: scene, repeats: ";
        Script const once = parse(body + "1}\n"), twice = parse(body + "2}\n");
        for (auto const& [unused, n] : surplus(trials_of(make_plan(once, 1), Phase::main), 0))
            EXPECT_LE(std::abs(n), levels % 2 == 1 ? 0 : 1) << levels;
        for (auto const& [unused, n] : surplus(trials_of(make_plan(twice, 1), Phase::main), 0)) EXPECT_EQ(n, 0);
        // Within a scene: every pair in both orders over two participants, or two repeats.
        std::map<std::string, int> orders;
        auto const count = [&](Script const& s, int p) {
            for (Trial const& t : trials_of(make_plan(s, p), Phase::main))
                ++orders[t.order + std::to_string(t.stimuli[0].levels[0]) +
                         std::to_string(t.stimuli[1].levels[0]) + std::to_string(t.stimuli[0].levels[1])];
        };
        count(once, 1);
        count(once, 2);
        EXPECT_EQ(int(orders.size()), levels * (levels - 1) * 3);
        for (auto const& [unused, n] : orders) EXPECT_EQ(n, 1);
        orders.clear();
        count(twice, 1);
        EXPECT_EQ(int(orders.size()), levels * (levels - 1) * 3);
    }
}

TEST(Pairs, AreNotTiedToOrdersThatAlternate)
{
    Script const s = parse("factors: {q: [a, b], scene: [s]}\nsequence: [x]\nblocks:\n"
                           "  x: {task: pair, pairs: {factor: q}, cross: scene}\n");
    std::map<std::string, int> count; // odd or even participant, and the order of the pair
    for (int p = 1; p <= 8; ++p) ++count[std::to_string(p % 2) + trials_of(make_plan(s, p), Phase::main)[0].order];
    EXPECT_EQ(count, (std::map<std::string, int>{{"0ab", 2}, {"0ba", 2}, {"1ab", 2}, {"1ba", 2}}));
}

TEST(Pairs, OfAListAreBalancedToo)
{
    Script const s = parse("factors: {q: [a, b, c, d, e], scene: [s]}\nsequence: [x]\nblocks:\n"
                           "  x: {task: pair, pairs: {factor: q, list: [[a, b], [a, c], [a, d], [a, e], [b, c]]},"
                           " cross: scene}\n");
    for (auto const& [unused, n] : surplus(trials_of(make_plan(s, 1), Phase::main), 0)) EXPECT_LE(std::abs(n), 1);
}

TEST(Answers, AreBalancedWithinEveryCondition)
{
    struct Case {
        char const* task;
        int orders;
    };
    for (Case const& c : {Case{"same_different", 4}, {"abx", 4}, {"oddity", 6}, {"2ifc", 2}, {"yes_no", 2}}) {
        bool const has_pairs = std::string(c.task) != "2ifc" && std::string(c.task) != "yes_no";
        for (bool const with_pairs : {false, true}) {
            if (with_pairs && !has_pairs) continue;
            Script const s = parse("factors: {q: [a, b, c], scene: [s, t]}\nreference: {q: a}\n"
                                   "defaults: {stimulus_ms: 100}\nsequence: [x]\nblocks:\n  x: {task: " +
                                   std::string(c.task) + ", " + (with_pairs ? "pairs" : "compare") +
                                   ": {factor: q}, cross: scene, repeats: 12}\n");
            std::map<std::string, int> count;
            for (Trial const& t : trials_of(make_plan(s, 1), Phase::main)) {
                ++count[std::to_string(t.stimuli[0].levels[0]) + std::to_string(t.stimuli[1].levels[0]) +
                        std::to_string(t.stimuli[0].levels[1]) + t.order];
                // The answer is the one the order says.
                auto const at = [&](std::size_t i) { return t.order[i]; };
                std::string const task = c.task;
                std::string expected = at(0) == 'a' ? "first" : "second"; // 2ifc
                if (task == "yes_no") expected = at(0) == 'a' ? "yes" : "no";
                if (task == "same_different") expected = at(0) == at(1) ? "same" : "different";
                if (task == "abx") expected = at(2) == at(0) ? "first" : "second";
                if (task == "oddity") expected = at(1) == at(2) ? "first" : at(0) == at(2) ? "second" : "third";
                EXPECT_EQ(t.answer, expected) << task << " " << t.order;
            }
            EXPECT_EQ(int(count.size()), (with_pairs ? 3 : 2) * 2 * c.orders) << c.task;
            for (auto const& [unused, n] : count) EXPECT_EQ(n, 12 / c.orders) << c.task;
        }
    }
}

TEST(Procedures, HaveTheirTrialsAndInterleave)
{
    Script const s = parse_script(example_text("staircase"), "s");
    auto const trials = trials_of(make_plan(s, 1), Phase::main, 1);
    std::map<int, int> count, answers;
    for (Trial const& t : trials) {
        ++count[t.procedure];
        answers[t.procedure] += t.answer == "first" ? 1 : -1;
        EXPECT_FALSE(t.level); // they choose it themselves
        EXPECT_TRUE(t.stimuli[0].is_varied);
        EXPECT_FALSE(t.stimuli[1].is_varied);
    }
    EXPECT_EQ(count, (std::map<int, int>{{0, 50}, {1, 50}, {2, 40}}));
    for (auto const& [unused, n] : answers) EXPECT_EQ(n, 0);
    std::map<double, int> levels;
    for (Trial const& t : trials_of(make_plan(s, 1), Phase::main, 0)) ++levels[std::round(t.level.value())];
    EXPECT_EQ(levels, (std::map<double, int>{{1, 6}, {4, 6}, {16, 6}, {64, 6}, {256, 6}}));
    std::map<double, int> starts;
    for (Trial const& t : trials_of(make_plan(s, 1), Phase::main, 2)) ++starts[t.level.value()];
    EXPECT_EQ(starts, (std::map<double, int>{{1, 3}, {64, 3}}));
}

TEST(CatchTrials, ComeOnceInEveryStretchAndNeverFirst)
{
    Script const s = parse_script(example_text("staircase"), "s");
    std::set<std::size_t> places;
    for (int p = 1; p <= 10; ++p) {
        auto const run = run_of(make_plan(s, p), 1);
        ASSERT_EQ(run.size(), 147u);
        for (std::size_t k = 0; k < 7; ++k) {
            int catches = 0;
            for (std::size_t i = k * 21; i < (k + 1) * 21; ++i)
                if (run[i].phase == Phase::catches) {
                    ++catches;
                    places.insert(i % 21);
                    EXPECT_EQ(run[i].level.value(), 1); // the easiest
                    EXPECT_FALSE(run[i].answer.empty());
                }
            EXPECT_EQ(catches, 1);
        }
    }
    EXPECT_FALSE(places.contains(0));
    EXPECT_GT(places.size(), 10u);
}

TEST(CatchTrials, CanBeWithoutAnythingToFind)
{
    Script const s = parse("factors: {q: {best: {paths: 4096}}}\nreference: {q: best}\nsequence: [b]\nblocks:\n"
                           "  b:\n    task: yes_no\n    catch: {every: 4, level: none}\n"
                           "    compare: {vary: paths, scale: log2, range: [1, 1024], harder: up}\n"
                           "    procedure: {method: staircase, start: 4, steps: [1], stop: {trials: 20}}\n");
    Plan const plan = make_plan(s, 1);
    for (Trial const& t : trials_of(plan, Phase::main)) EXPECT_EQ(t.answer, "yes");
    auto const catches = trials_of(plan, Phase::catches);
    ASSERT_EQ(catches.size(), 5u);
    for (Trial const& t : catches) {
        EXPECT_EQ(t.order, "b");
        EXPECT_EQ(t.answer, "no");
    }
}

TEST(Nesting, ShowsInnerLevelsWithinTheirOuterOnesOnly)
{
    Script const s = parse_script(example_text("rating"), "r");
    std::map<std::string, int> count;
    for (Trial const& t : trials_of(make_plan(s, 3), Phase::main))
        ++count[s.factors[0].levels[std::size_t(t.stimuli[0].levels[0])].name + "/" +
                s.factors[1].levels[std::size_t(t.stimuli[0].levels[1])].name];
    EXPECT_EQ(count,
              (std::map<std::string, int>{{"atrium/gallery", 6}, {"atrium/court", 6}, {"cornell/front", 6}}));
}

TEST(Shuffle, StaysWithinRepeatsOrLeavesThemAsListed)
{
    std::string const body = "factors: {scene: [a, b, c, d]}\nsequence: [x]\nblocks:\n"
                             "  x: {task: rating, scale: {min: 1, max: 7}, cross: scene, repeats: 6, shuffle: ";
    auto const within = trials_of(make_plan(parse(body + "within_repeats}\n"), 1), Phase::main);
    auto const none = trials_of(make_plan(parse(body + "none}\n"), 1), Phase::main);
    for (std::size_t r = 0; r < 6; ++r) {
        std::set<int> seen;
        for (std::size_t i = 0; i < 4; ++i) {
            seen.insert(within[4 * r + i].stimuli[0].levels[0]);
            EXPECT_EQ(none[4 * r + i].stimuli[0].levels[0], int(i));
        }
        EXPECT_EQ(seen.size(), 4u);
    }
}

TEST(Settings, OfAStimulusAreThoseOfAllItsParts)
{
    Script const s = parse_script(example_text("visibility2026"), "v");
    for (PlanStep const& step : make_plan(s, 1).steps) {
        if (step.kind != PlanStepKind::trial || step.block != 2 || step.trial.phase != Phase::catches) continue;
        Patch const varied = settings_of(s, s.blocks[2], step.trial.stimuli[0]);
        Patch const exact = settings_of(s, s.blocks[2], step.trial.stimuli[1]);
        std::string const view = step.levels[2] == 0 ? "window" : "openxr";
        EXPECT_EQ(varied, (Patch{{"scene", "atrium"},
                                 {"camera", "arches"},
                                 {"gi.visibility", "imperfect"},
                                 {"view", view},
                                 {"gi.points", "64"}}));
        EXPECT_EQ(exact,
                  (Patch{{"scene", "atrium"}, {"camera", "arches"}, {"gi.visibility", "exact"}, {"view", view}}));
    }
}

TEST(Duration, IsTheSumOfItsParts)
{
    Script const s =
        parse("timing: {expected_hz: 50}\nfactors: {q: [a, b], scene: [s]}\n"
              "defaults: {warmup_frames: 100, iti_ms: 700, stimulus_ms: 1500, isi_ms: 300}\n"
              "sequence: [{questionnaire: ssq}, x, {break: 20}]\nblocks:\n"
              "  x: {task: pair, presentation: sequential, pairs: {factor: q}, cross: scene, repeats: 5,"
              " expected_response_ms: 1000, break_every: 2, break_s: 8}\n");
    Plan const plan = make_plan(s, 1);
    // 16 items of 6 s; 5 trials of 0.7 + 2 + 2 x 1.5 + 0.3 + 1; breaks after 2 and 4; 20 s
    EXPECT_EQ(plan.duration_us, 96000000 + 5 * 7000000 + 2 * 8000000 + 20000000);
    EXPECT_EQ(plan.steps[1].onset_us, 96000000 + 2700000);
    EXPECT_TRUE(find_doubts(s, plan).empty());
}

TEST(Doubts, AreLongSessionsAndUnbalancedCycles)
{
    Script const s = parse("factors: {scene: [a, b]}\ndefaults: {stimulus_ms: 20000}\nsequence: [x]\nblocks:\n"
                           "  x: {task: rating, scale: {min: 1, max: 7}, cross: scene, repeats: 100}\n");
    auto const doubts = find_doubts(s, make_plan(s, 1));
    ASSERT_EQ(doubts.size(), 2u);
    EXPECT_NE(doubts[0].find("60 minutes"), std::string::npos);
    EXPECT_NE(doubts[1].find("without a break"), std::string::npos);
    Script odd = parse_script(example_text("visibility2026"), "v");
    odd.participants.count = 13;
    ASSERT_EQ(find_doubts(odd).size(), 1u);
    EXPECT_NE(find_doubts(odd)[0].find("a multiple of 12 would"), std::string::npos);
}

TEST(Doubts, AreGuessRatesThatTheTaskCannotHave)
{
    auto const doubts = [](std::string const& task, std::string const& guess) {
        return find_doubts(parse("factors: {q: {best: {paths: 4096}}}\nreference: {q: best}\n"
                                 "defaults: {stimulus_ms: 1000}\nsequence: [b]\nblocks:\n  b:\n    task: " +
                                 task +
                                 "\n    compare: {vary: paths, scale: log2, range: [1, 1024], harder: up}\n"
                                 "    procedure: {method: questplus, threshold: 1..1024/21, slope: 2, guess: " +
                                 guess + ", lapse: 0.02, stop: {trials: 12}}\n"));
    };
    ASSERT_EQ(doubts("yes_no", "0.5").size(), 1u);
    EXPECT_NE(doubts("yes_no", "0.5")[0].find("false alarm rate"), std::string::npos);
    EXPECT_TRUE(doubts("yes_no", "[0.1, 0.5]").empty());
    EXPECT_TRUE(doubts("2ifc", "0.5").empty());
    EXPECT_TRUE(doubts("oddity", "0.33").empty());
    ASSERT_EQ(doubts("2ifc", "[0, 0.1]").size(), 1u);
    EXPECT_NE(doubts("2ifc", "[0, 0.1]")[0].find("is 0 to 0.1, but guessing gives 0.5 in 2ifc"),
              std::string::npos);
}

TEST(Doubts, AreFactorsThatAlwaysGoTogether)
{
    auto const doubts = [](std::string const& levels, std::string const& tones = "[warm, cold, grey]") {
        return find_doubts(
            parse("factors: {scene: [a, b], tone: " + tones +
                  "}\ndefaults: {stimulus_ms: 1000}\nsequence: [x]\n"
                  "blocks:\n  x: {task: rating, scale: {min: 1, max: 7}, cross: scene, repeats: 2,\n"
                  "      nest: {tone: {in: scene, levels: {" +
                  levels + "}}}}\n"));
    };
    ASSERT_EQ(doubts("a: warm, b: cold").size(), 1u);
    EXPECT_NE(doubts("a: warm, b: cold")[0].find("cannot be told apart"), std::string::npos);
    EXPECT_TRUE(doubts("a: [warm, cold], b: [cold, grey]").empty());
    EXPECT_TRUE(doubts("a: warm, b: warm").empty());
    EXPECT_TRUE(doubts("a: warm, b: cold", "{warm: {camera: left}, cold: {camera: front}}").empty())
        << "of scenes";
}

TEST(Doubts, AreProceduresThatCannotLearn)
{
    auto const idle = [](std::string const& procedure) {
        auto const found = find_idle_procedures(
            parse("factors: {q: {best: {paths: 4096}}}\nreference: {q: best}\n"
                  "defaults: {stimulus_ms: 1000}\nsequence: [b]\nblocks:\n  b:\n    task: 2ifc\n"
                  "    compare: {vary: paths, scale: log2, range: [1, 1024], harder: down}\n"
                  "    procedure: {" +
                  procedure + "}\n"));
        return found.empty() ? "" : found.at(0);
    };
    std::string const questplus =
        "method: questplus, levels: 1..1024/11, guess: 0.5, lapse: 0.02, stop: {trials: 9}, ";
    EXPECT_NE(idle(questplus + "threshold: 64, slope: 2").find("a prior of one point"), std::string::npos);
    EXPECT_NE(idle(questplus + "threshold: [64], slope: [2]").find("a prior of one point"), std::string::npos);
    EXPECT_NE(idle(questplus + "threshold: 64, slope: [1, 2]").find("a prior with one threshold, 64"),
              std::string::npos);
    EXPECT_EQ(idle(questplus + "threshold: [32, 64], slope: 2"), "");
    std::string const staircase = "method: staircase, down: 2, start: 512, stop: {trials: 9}, ";
    EXPECT_EQ(idle(staircase + "steps: [12, 2, 1]"), "");
    EXPECT_NE(idle(staircase + "steps: [2, 10]").find("ends with steps of 10 in a range that is 10 wide"),
              std::string::npos);
}

TEST(Doubts, AreLevelsThatLookAlikeAndTooFewActiveTrials)
{
    auto const doubts = [](std::string const& levels, std::string const& trials) {
        return find_doubts(parse("factors: {q: " + levels +
                                 "}\nsequence: [b]\nblocks:\n  b: {task: pair, pairs: "
                                 "{factor: q, sampling: active, trials: " +
                                 trials + "}}\n"));
    };
    EXPECT_TRUE(doubts("{a: {paths: 1}, b: {paths: 2}, c: {paths: 1, reuse: 1}}", "2").empty());
    EXPECT_TRUE(doubts("{a: {}, b: {}, c: {}}", "2").empty()) << "of another presenter";
    auto const alike = doubts("{a: {paths: 1}, b: {gi.paths: 1.0}, c: {paths: 3}}", "2");
    ASSERT_EQ(alike.size(), 1u);
    EXPECT_NE(alike[0].find("levels 'a' and 'b' of factor 'q' have the same settings"), std::string::npos);
    auto const few = doubts("[a, b, c, d]", "2");
    ASSERT_EQ(few.size(), 1u);
    EXPECT_NE(few[0].find("2 active trials cannot connect 4 levels; at least 3 would"), std::string::npos);
}

TEST(Transitions, CountNeighbours)
{
    Script const s =
        parse("factors: {scene: [a, b, c]}\nsequence: [x]\nblocks:\n"
              "  x: {task: rating, scale: {min: 1, max: 7}, cross: scene, repeats: 4, shuffle: none}\n");
    auto const all = find_transitions(s, make_plan(s, 1));
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].counts, (std::vector<int>{0, 4, 0, 0, 0, 4, 3, 0, 0}));
    EXPECT_DOUBLE_EQ(all[0].switched, 1);
    EXPECT_DOUBLE_EQ(all[0].by_chance, 1 - 3 * 4 * 3 / (12.0 * 11));
}

TEST(PlanTable, HasAsManyCellsInEveryLine)
{
    for (char const* name : {"visibility2026", "pairs", "staircase", "rating"}) {
        Script const s = parse_script(example_text(name), name);
        std::string const table = plan_table(s, make_plan(s, 1));
        std::size_t line_start = 0;
        auto const tabs = std::count(table.begin(), table.begin() + long(table.find('\n')), '\t');
        for (std::size_t end = 0; (end = table.find('\n', line_start)) != std::string::npos;
             line_start = end + 1) {
            EXPECT_EQ(std::count(table.begin() + long(line_start), table.begin() + long(end), '\t'), tabs);
            EXPECT_EQ(table.substr(line_start, end - line_start).find("\t\t"), std::string::npos);
        }
        EXPECT_EQ(table.back(), '\n');
    }
}

} // namespace
} // namespace study::test
