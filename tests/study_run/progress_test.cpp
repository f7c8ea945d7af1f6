#include "study/run/progress.h"

#include "tests/study_run/support.h"

#include <cmath>
#include <set>

namespace study::test {
namespace {

/// Steps and attempts in the order in which they are done.
struct Walk {
    Script script;
    Plan plan = make_plan(script, 1);
    Progress progress{script, plan};
    std::vector<NextStep> done;

    explicit Walk(Script s) : script(std::move(s)) {}

    PlanStep const& at(int step) const { return plan.steps[std::size_t(step)]; }

    TrialDone trial(NextStep const& due, bool is_correct = true) const
    {
        TrialDone t;
        t.step = due.step;
        t.attempt = due.attempt;
        t.level = due.level;
        t.is_correct = is_correct;
        return t;
    }
    /// To the end; `answer` changes trials.
    void go(std::function<void(NextStep const&, TrialDone&)> const& answer, std::size_t most = 10000)
    {
        for (auto due = progress.next(); due && most > 0; due = progress.next(), --most) {
            done.push_back(*due);
            if (at(due->step).kind == PlanStepKind::trial) {
                TrialDone t = trial(*due);
                answer(*due, t);
                progress.apply(t);
            } else if (at(due->step).kind == PlanStepKind::questionnaire) {
                progress.apply(QuestionnaireDone{due->step, 0, 1, {}});
            } else {
                progress.apply(StepDone{due->step, 0, 1, ""});
            }
        }
    }
    int count(int step) const
    {
        return int(std::count_if(done.begin(), done.end(), [&](NextStep const& d) { return d.step == step; }));
    }
};

void well(NextStep const&, TrialDone&) {}

TEST(Progress, GoesThroughThePlanInItsOrder)
{
    Walk w(rating_script());
    w.go(well);
    ASSERT_EQ(w.done.size(), w.plan.steps.size());
    for (std::size_t i = 0; i < w.done.size(); ++i) EXPECT_EQ(w.done[i].step, int(i));
    EXPECT_EQ(w.progress.trials_done(), w.progress.trials_planned());
}

TEST(Progress, BadTrialsComeAgainAtTheEndOfTheirBlock)
{
    Walk w(rating_script());
    int const first = 5, second = 9;
    w.go([&](NextStep const& due, TrialDone& t) {
        t.is_valid = due.attempt > 1 || (due.step != first && due.step != second);
    });
    ASSERT_EQ(w.done.size(), w.plan.steps.size() + 2);
    EXPECT_EQ(w.done[w.done.size() - 2].step, first);
    EXPECT_EQ(w.done.back().step, second);
    EXPECT_EQ(w.done.back().attempt, 2);
}

TEST(Progress, BadTrialsComeThreeTimesAtMost)
{
    Walk w(rating_script());
    w.go([](NextStep const&, TrialDone& t) { t.is_valid = false; });
    for (std::size_t i = 2; i < w.plan.steps.size(); ++i) // after questionnaire and instructions
        EXPECT_EQ(w.count(int(i)), w.at(int(i)).trial.phase == Phase::practice ? 1 : kMostAttempts);
}

TEST(Progress, BadTrialsAreKeptWhereTheScriptSaysSo)
{
    Walk w(rating_script(4, "", ", on_bad_trial: keep"));
    w.go([](NextStep const&, TrialDone& t) { t.is_valid = false; });
    EXPECT_EQ(w.done.size(), w.plan.steps.size());
}

TEST(Progress, SkippedTrialsDoNotComeAgain)
{
    Walk w(rating_script());
    w.go([](NextStep const& due, TrialDone& t) {
        t.is_valid = due.step != 6;
        if (!t.is_valid) t.reason = "skipped";
    });
    EXPECT_EQ(w.count(6), 1);
}

TEST(Progress, StaircasesStepAsTheyShould)
{
    Walk w(adaptive_script());
    int const procedure = 0;
    std::vector<double> levels;
    std::vector<bool> const answers{true, true, true, true, false, true, true, false}; // 2 down, 1 up
    w.go([&](NextStep const& due, TrialDone& t) {
        Trial const& trial = w.at(due.step).trial;
        if (trial.procedure != procedure || trial.phase != Phase::main) return;
        t.is_correct = levels.size() < answers.size() ? bool(answers[levels.size()]) : true;
        levels.push_back(*due.level);
    });
    // Harder is up: two right ones go up by 2 octaves, and by 1 after the first reversal.
    std::vector<double> const expected{16, 16, 64, 64, 256, 128, 128, 256, 128, 128};
    ASSERT_EQ(levels.size(), expected.size()) << "four reversals";
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_DOUBLE_EQ(levels[i], expected[i]) << i;
}

TEST(Progress, WeightedStaircasesStepUnequally)
{
    Walk w(parse(R"(
timing: {vsync: record}
factors: {quality: {many: {paths: 4096}}}
reference: {quality: many}
sequence: [paths]
blocks:
  paths:
    task: 2ifc
    prompt: "Which?"
    stimulus_ms: 1000
    compare: {vary: exposure, scale: linear, range: [0, 100], harder: down}
    procedure: {method: staircase, target: 0.75, start: 50, steps: 2, stop: {max_trials: 6}}
)"));
    std::vector<double> levels;
    w.go([&](NextStep const& due, TrialDone& t) {
        levels.push_back(*due.level);
        t.is_correct = levels.size() % 2 == 1;
    });
    EXPECT_EQ(levels, (std::vector<double>{50, 48, 54, 52, 58, 56}));
}

TEST(Progress, WhatARunNoLongerNeedsFallsAway)
{
    Walk w(adaptive_script());
    int staircase = 0, quest = 0;
    w.go([&](NextStep const& due, TrialDone& t) {
        Trial const& trial = w.at(due.step).trial;
        if (trial.phase != Phase::main) return;
        ++(trial.procedure == 0 ? staircase : quest);
        if (trial.procedure == 0) t.is_correct = staircase % 3 > 0;
    });
    EXPECT_LT(staircase, 30);
    EXPECT_EQ(quest, 12);
    NextStep const last = w.done.back();
    EXPECT_EQ(w.at(last.step).trial.phase, Phase::main) << "a catch trial or a break after the last main trial";
}

TEST(Progress, ProceduresHearOfValidTrialsOnly)
{
    for (int const procedure : {0, 1}) {
        Walk w(adaptive_script());
        std::vector<double> levels;
        int bad = -1;
        w.go([&](NextStep const& due, TrialDone& t) {
            Trial const& trial = w.at(due.step).trial;
            if (trial.procedure != procedure || trial.phase != Phase::main) return;
            levels.push_back(*due.level);
            t.is_correct = levels.size() % 3 > 0;
            if (levels.size() != 5) return;
            bad = due.step;
            t.is_valid = false;
        });
        ASSERT_GT(levels.size(), 6u);
        EXPECT_EQ(levels[5], levels[4]);
        EXPECT_EQ(w.count(bad), procedure == 0 ? 1 : 2) << "staircases ended by reversals need it no more";
    }
}

TEST(Progress, QuestPlusAsksForItsLevels)
{
    Walk w(adaptive_script());
    std::vector<double> levels;
    w.go([&](NextStep const& due, TrialDone& t) {
        Trial const& trial = w.at(due.step).trial;
        if (trial.procedure != 1 || trial.phase != Phase::main) return;
        t.is_correct = *due.level < 60; // a sharp threshold
        levels.push_back(*due.level);
    });
    ASSERT_EQ(levels.size(), 12u);
    EXPECT_NEAR(std::log2(levels.back()), std::log2(60), 2.1);
    EXPECT_GT(std::set<double>(levels.begin(), levels.end()).size(), 3u);
}

/// As of a version whose procedures chose otherwise.
TEST(Progress, RecordedLevelsCountWhereAProcedureChoosesOthersNow)
{
    Walk w(adaptive_script());
    std::map<int, std::vector<double>> levels; // by procedure
    w.go([&](NextStep const& due, TrialDone& t) {
        Trial const& trial = w.at(due.step).trial;
        if (trial.procedure < 0 || trial.phase != Phase::main) return;
        auto& of_run = levels[trial.procedure];
        of_run.push_back(*due.level);
        if (of_run.size() == 1) t.level = trial.procedure == 0 ? 64 : 1;
        t.is_correct = true;
    });
    EXPECT_EQ(w.progress.levels_not_due(), 2);
    ASSERT_GT(levels[0].size(), 2u);
    EXPECT_EQ(levels[0][0], 16);
    EXPECT_EQ(levels[0][1], 64) << "the recorded level, until two responses are right";
    EXPECT_EQ(levels[0][2], 256) << "a step of 2 beyond it";
    EXPECT_EQ(levels[1].size(), 12u);
}

TEST(Progress, RefusesEntriesThatDoNotFollow)
{
    Walk w(adaptive_script());
    EXPECT_THROW(w.progress.apply(StepDone{3, 0, 1, ""}), std::invalid_argument);
    EXPECT_THROW(w.progress.apply(w.trial({0, 1, false, {}})), std::invalid_argument);
    w.go(well, 6);
    NextStep const due = *w.progress.next();
    TrialDone t = w.trial(due);
    t.attempt = 2;
    EXPECT_THROW(w.progress.apply(t), std::invalid_argument);
    t = w.trial(due);
    t.level = 2048; // the script has none above 1024
    EXPECT_THROW(w.progress.apply(t), std::invalid_argument);
    t.level.reset();
    EXPECT_THROW(w.progress.apply(t), std::invalid_argument);
    w.progress.apply(w.trial(due));
}

TEST(Progress, AfterALongGapInstructionsAndPracticeComeAgain)
{
    for (double const gap_s : {3700.0, -7200.0, 10.0, -5.0}) {
        Walk w(rating_script());
        w.go(well, 9); // questionnaire, instructions, two of practice, five trials
        int const due = w.progress.next()->step;
        ASSERT_EQ(due, 9);
        SessionStarted again;
        again.part = 2;
        again.gap_s = gap_s;
        w.progress.apply(again);
        w.done.clear();
        w.go(well);
        std::vector<int> steps;
        for (NextStep const& d : w.done) steps.push_back(d.step);
        bool const is_long = std::abs(gap_s) > 100;
        std::vector<int> const expected = is_long ? std::vector<int>{1, 2, 3, 9} : std::vector<int>{9, 10, 11, 12};
        EXPECT_EQ(std::vector<int>(steps.begin(), steps.begin() + 4), expected) << gap_s;
        EXPECT_EQ(w.done[0].attempt, is_long ? 2 : 1);
        EXPECT_EQ(steps.size(), w.plan.steps.size() - 9 + (is_long ? 3 : 0));
    }
}

TEST(Progress, AGapWithinARepetitionGoesOnWithIt)
{
    Walk w(rating_script());
    w.go(well, 9);
    SessionStarted again;
    again.part = 2;
    again.gap_s = 1e5;
    w.progress.apply(again);
    w.go(well, 2); // the instructions and the first of practice
    again.part = 3;
    again.gap_s = 1;
    w.progress.apply(again);
    EXPECT_EQ(w.progress.next()->step, 3);
    again.part = 4;
    again.gap_s = 1e5;
    w.progress.apply(again);
    EXPECT_EQ(w.progress.next()->step, 1);
    EXPECT_EQ(w.progress.next()->attempt, 3);
}

TEST(Progress, OfTheScriptDecidesWhatComesAgain)
{
    Walk w(rating_script(4, "resume: {max_gap_min: 10, repeat: [practice]}\n"));
    w.go(well, 9);
    SessionStarted again;
    again.part = 2;
    again.gap_s = 700;
    w.progress.apply(again);
    EXPECT_EQ(w.progress.next()->step, 2);
}

TEST(Progress, QuestionnairesOfConditionsFollowTheirTrials)
{
    Walk w(parse(R"(
timing: {vsync: record}
factors: {scene: [atrium, cornell]}
sequence: [ask, walk]
blocks:
  ask: {task: questionnaire, questionnaire: sus_presence, cross: [scene]}
  walk: {task: free_walk, duration_s: 5, cross: [scene]}
)"));
    ASSERT_EQ(w.plan.steps.size(), 4u);
    TrialDone bad = w.trial(*w.progress.next());
    bad.is_valid = false;
    w.progress.apply(bad);
    EXPECT_EQ(w.progress.next()->step, 1);
    w.progress.apply(w.trial(*w.progress.next()));
    EXPECT_EQ(w.progress.next()->step, 1);
    EXPECT_TRUE(w.progress.next()->is_questionnaire_of_trial);
    EXPECT_THROW(w.progress.apply(w.trial({1, 2, false, {}})), std::invalid_argument);
    w.progress.apply(QuestionnaireDone{1, 0, 1, {}});
    EXPECT_EQ(w.progress.next()->step, 0);
    EXPECT_EQ(w.progress.next()->attempt, 2);
    w.progress.apply(w.trial(*w.progress.next()));
    w.progress.apply(StepDone{0, 0, 0, "skipped"});
    for (int step = 2; step < 4; ++step) {
        EXPECT_EQ(w.progress.next()->step, step);
        w.progress.apply(StepDone{step, 0, 5, ""});
    }
    EXPECT_FALSE(w.progress.next());
}

} // namespace
} // namespace study::test
