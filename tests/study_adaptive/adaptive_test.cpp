// Staircases and QUEST+ against published sequences, and against observers that are simulated.

#include "study/adaptive/questplus.h"
#include "study/adaptive/staircase.h"

#include "study/numeric/random.h"
#include "study/stats/psychometric_fit.h"
#include "tests/study_stats/support/study_data.h"

#include <cmath>

namespace study::test {
namespace {

StaircaseSettings settings_of(nlohmann::json const& params)
{
    StaircaseSettings s;
    s.start = params["start"];
    s.steps = params["steps"].get<std::vector<double>>();
    s.up = params["n_up"];
    s.down = params["n_down"];
    s.low = params.value("lo", s.low);
    s.high = params.value("hi", s.high);
    s.up_ratio = params.value("step_up_ratio", 1.0);
    std::string const kind = params.value("step_type", "lin");
    s.kind = kind == "lin" ? StepKind::linear : kind == "log" ? StepKind::log10 : StepKind::db;
    s.initial = params.value("initial_rule", true) ? InitialRule::one_by_one : InitialRule::none;
    s.stop.max_trials = 1000;
    return s;
}

TEST(Staircase, FollowsThePublishedRulesExactly)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const vectors = read_json("staircase_vectors.json")["vectors"];
    EXPECT_EQ(vectors.size(), 5u);
    for (auto const& v : vectors) {
        Staircase s(settings_of(v["params"]));
        for (int const response : v["responses"].get<std::vector<int>>()) s.respond(response);
        std::string const name = v["name"];
        double const digits = 1e-11; // the file has 12 decimals
        expect_near(s.levels(), v["levels"], digits, name);
        EXPECT_NEAR(s.level(), double(v["next_level"]), digits) << name;
        ASSERT_EQ(s.reversals().size(), v["reversal_trials"].size()) << name;
        for (std::size_t i = 0; i < s.reversals().size(); ++i) {
            EXPECT_EQ(s.reversals()[i].trial, v["reversal_trials"][i]) << name;
            EXPECT_NEAR(s.reversals()[i].level, double(v["reversal_levels"][i]), digits) << name;
        }
        EXPECT_NEAR(*mean_of_reversals(s, 6), double(v["mean_last_6_reversals"]), digits) << name;
    }
}

TEST(Staircase, TargetsAreThoseOfTheTransformedRules)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const e = read_json("sdt_and_constants.expected.json")["transformed_updown_target_p"];
    for (std::size_t i = 0; i < e["n_down"].size(); ++i) {
        StaircaseSettings s;
        s.down = e["n_down"][i];
        EXPECT_NEAR(staircase_target(s), double(e["p"][i]), 1e-6);
    }
    StaircaseSettings weighted;
    weighted.down = 1;
    weighted.up_ratio = 3;
    EXPECT_NEAR(staircase_target(weighted), 0.75, 1e-12); // Kaernbach 1991
    StaircaseSettings two_up;
    two_up.up = 2;
    two_up.down = 1;
    EXPECT_NEAR(staircase_target(two_up), 1 - std::sqrt(0.5), 1e-12);
}

TEST(Staircase, SettlesInTheLongRunWhereItShould)
{
    for (auto const& [down, ratio] : {std::pair{2, 1.0}, {3, 1.0}, {1, 3.0}}) {
        StaircaseSettings s;
        s.start = 0;
        s.steps = {0.05}; // small against the observer's spread, 1
        s.down = down;
        s.up_ratio = ratio;
        s.initial = InitialRule::none;
        s.stop.max_trials = 200000;
        Staircase stairs(s);
        Random random(8);
        double correct = 0;
        while (!stairs.finished()) {
            bool const right = random.uniform() < proportion_at({}, {0, 1, 0, 0}, stairs.level());
            correct += right;
            stairs.respond(right);
        }
        double const target = staircase_target(s);
        EXPECT_NEAR(correct / s.stop.max_trials / target, 1, 0.02) << down;
        EXPECT_NEAR(*mean_of_reversals(stairs), level_at({}, {0, 1, 0, 0}, target), 0.1) << down;
    }
}

TEST(Staircase, MeanOfReversalsAndCurveAgreeOnItsTrials)
{
    StaircaseSettings s;
    s.start = 3;
    s.steps = {1, 0.5, 0.25};
    s.stop.max_trials = 400;
    Staircase stairs(s);
    Random random(12);
    PsychometricParameters const truth{0.5, 0.8, 0.5, 0};
    std::vector<int> responses;
    while (!stairs.finished()) {
        responses.push_back(random.uniform() < proportion_at({}, truth, stairs.level()));
        stairs.respond(responses.back());
    }
    PsychometricSettings settings;
    settings.guess.value = 0.5;
    auto const fit = fit_psychometric(count_levels(stairs.levels(), responses), settings);
    double const level = level_at({}, truth, staircase_target(s));
    EXPECT_NEAR(*mean_of_reversals(stairs), level, 0.25);
    EXPECT_NEAR(level_at(fit.shape, fit.parameters, staircase_target(s)), level, 0.25);
}

TEST(Staircase, StopsByTheRuleThatIsWrittenDown)
{
    StaircaseSettings s;
    s.down = 1;
    s.start = 10;
    s.stop = {4, 0, 30};
    Staircase by_reversals(s);
    for (int i = 0; !by_reversals.finished(); ++i) by_reversals.respond(i % 2);
    EXPECT_EQ(by_reversals.reversals().size(), 4u);
    EXPECT_EQ(by_reversals.levels().size(), 5u);
    EXPECT_THROW(by_reversals.respond(true), std::logic_error);

    s.stop = {4, 12, 30};
    Staircase at_least(s);
    for (int i = 0; !at_least.finished(); ++i) at_least.respond(i % 2);
    EXPECT_EQ(at_least.levels().size(), 12u);

    s.stop = {4, 0, 30};
    Staircase monotone(s);
    while (!monotone.finished()) monotone.respond(true);
    EXPECT_EQ(monotone.levels().size(), 30u);
    EXPECT_FALSE(mean_of_reversals(monotone));
}

TEST(Staircase, RefusesRulesThatCannotRun)
{
    auto const make = [](auto const& change) {
        StaircaseSettings s;
        s.stop.max_trials = 10;
        change(s);
        return Staircase(s);
    };
    EXPECT_NO_THROW(make([](StaircaseSettings&) {}));
    EXPECT_THROW(make([](StaircaseSettings& s) { s.steps.clear(); }), std::invalid_argument);
    EXPECT_THROW(make([](StaircaseSettings& s) { s.steps = {1, 0}; }), std::invalid_argument);
    EXPECT_THROW(make([](StaircaseSettings& s) { s.steps = {NAN}; }), std::invalid_argument);
    EXPECT_THROW(make([](StaircaseSettings& s) { s.down = 0; }), std::invalid_argument);
    EXPECT_THROW(make([](StaircaseSettings& s) { s.up_ratio = 0; }), std::invalid_argument);
    EXPECT_THROW(make([](StaircaseSettings& s) { s.high = 0.5; }), std::invalid_argument);
    EXPECT_THROW(make([](StaircaseSettings& s) { s.start = NAN; }), std::invalid_argument);
    EXPECT_THROW(make([](StaircaseSettings& s) { s.kind = StepKind::log10, s.start = -1; }),
                 std::invalid_argument);
    EXPECT_THROW(make([](StaircaseSettings& s) { s.stop = {}; }), std::invalid_argument);
}

QuestSettings watson(nlohmann::json const& e)
{
    QuestSettings s;
    s.stimuli = e["stimulus_dB"].get<std::vector<double>>();
    s.threshold = e["threshold_dB"].get<std::vector<double>>();
    s.slope = e["slope"].get<std::vector<double>>();
    s.guess = e["guess"].get<std::vector<double>>();
    s.lapse = e["lapse"].get<std::vector<double>>();
    return s;
}

TEST(QuestPlus, ShowsTheStimuliOfWatsonsFirstExample)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const e = read_json("questplus_watson_ex1.json");
    QuestPlus quest(watson(e));
    auto const responses = e["responses_1_is_correct"].get<std::vector<int>>();
    ASSERT_EQ(responses.size(), 32u);
    for (std::size_t i = 0; i < responses.size(); ++i) {
        std::size_t const next = quest.next();
        EXPECT_EQ(quest.settings().stimuli[next], double(e["expected_stimuli_dB"][i])) << i;
        quest.respond(next, responses[i]);
    }
    auto const &x = e["expected"], &tolerance = e["tolerance"];
    EXPECT_EQ(quest.mode().threshold, double(x["mode_threshold"]));
    EXPECT_NEAR(quest.mean().threshold, double(x["mean_threshold"]), double(tolerance["mean"]));
    EXPECT_NEAR(quest.standard_deviation().threshold, double(x["sd_threshold"]), double(tolerance["sd"]));
    EXPECT_NEAR(quest.posterior()[10], double(x["posterior_index10"]), double(tolerance["posterior"]));
    EXPECT_NEAR(quest.entropy() - quest.expected_information(8), double(x["expected_entropy_bits_stim_index8"]),
                double(tolerance["entropy"]));
}

TEST(QuestPlus, FindsThresholdAndSlopeOfASimulatedObserver)
{
    for (QuestFunction const function :
         {QuestFunction::weibull_db, QuestFunction::weibull, QuestFunction::gaussian, QuestFunction::logistic})
        for (Direction const direction : {Direction::rising, Direction::falling}) {
            QuestSettings s;
            s.function = function;
            s.direction = direction;
            for (double x = 1; x <= 21; x += 1) s.stimuli.push_back(x);
            s.threshold = s.stimuli;
            s.slope = {0.5, 1, 2, 4};
            s.lapse = {0, 0.02, 0.04};
            QuestPlus quest(s);
            Random random(6);
            QuestParameters const truth{11, 2, 0.5, 0.02};
            for (int trial = 0; trial < 400; ++trial) {
                std::size_t const i = quest.next();
                quest.respond(i, random.uniform() < proportion_at(function, direction, truth, s.stimuli[i]));
            }
            double const deviation = quest.standard_deviation().threshold;
            EXPECT_LT(deviation, 1.5);
            EXPECT_NEAR(quest.mean().threshold, truth.threshold, 4 * deviation + 0.05);
        }
}

TEST(QuestPlus, ExpectedEntropyIsWhatIsLeftOnAverage)
{
    QuestSettings s;
    s.stimuli = {1, 2, 4};
    s.threshold = {1, 2, 3};
    s.slope = {1, 3};
    s.function = QuestFunction::weibull;
    s.threshold_prior = {1, 2, 1};
    QuestPlus const quest(s);
    for (std::size_t i = 0; i < 3; ++i) {
        double p = 0, total = 0; // P(correct) under the prior
        for (std::size_t t = 0; t < 3; ++t)
            for (double const slope : s.slope) {
                p += s.threshold_prior[t] *
                     proportion_at(s.function, s.direction, {s.threshold[t], slope, 0.5, 0.02}, s.stimuli[i]);
                total += s.threshold_prior[t];
            }
        p /= total;
        QuestPlus right = quest, wrong = quest;
        right.respond(i, true);
        wrong.respond(i, false);
        EXPECT_NEAR(quest.entropy() - quest.expected_information(i),
                    p * right.entropy() + (1 - p) * wrong.entropy(), 1e-12);
    }
}

TEST(QuestPlus, TakesTheFirstOfTiedStimuli)
{
    QuestSettings s;
    s.function = QuestFunction::gaussian;
    s.threshold = {-1, 1};
    s.slope = {1};
    s.guess = {0};
    s.lapse = {0};
    s.stimuli = {5, -0.5, 0.5}; // the last two are mirror images
    EXPECT_EQ(QuestPlus(s).next(), 1u);
}

TEST(QuestPlus, RefusesWhatHasNoPosterior)
{
    QuestSettings good;
    good.stimuli = good.threshold = {1, 2};
    good.slope = {1};
    auto const make = [&](auto const& change) {
        QuestSettings s = good;
        change(s);
        return QuestPlus(s);
    };
    EXPECT_THROW(make([](QuestSettings& s) { s.stimuli.clear(); }), std::invalid_argument);
    EXPECT_THROW(make([](QuestSettings& s) { s.threshold = {NAN}; }), std::invalid_argument);
    EXPECT_THROW(make([](QuestSettings& s) { s.slope = {0}; }), std::invalid_argument);
    EXPECT_THROW(make([](QuestSettings& s) { s.guess = {0.99}; }), std::invalid_argument);
    EXPECT_THROW(make([](QuestSettings& s) { s.threshold_prior = {1}; }), std::invalid_argument);
    EXPECT_THROW(make([](QuestSettings& s) { s.threshold_prior = {0, 0}; }), std::invalid_argument);
    EXPECT_THROW(make([](QuestSettings& s) { s.function = QuestFunction::weibull, s.threshold = {-1}; }),
                 std::invalid_argument);
    QuestPlus quest(good);
    EXPECT_THROW(quest.respond(2, true), std::invalid_argument);

    QuestPlus sure = make([](QuestSettings& s) {
        s.function = QuestFunction::gaussian;
        s.stimuli = {1000, -1000};
        s.guess = s.lapse = {0};
    });
    EXPECT_THROW(sure.respond(1, true), std::invalid_argument);
    EXPECT_NEAR(sure.entropy(), 1, 1e-12); // as before
}

} // namespace
} // namespace study::test
