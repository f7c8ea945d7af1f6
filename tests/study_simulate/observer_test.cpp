#include "study/script/script_error.h"
#include "study/stats/binomial.h"
#include "tests/study_simulate/support.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace study::test {
namespace {

double phi(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }
constexpr double kSigma = 1.4826022185056018;

std::function<bool(Trial const&)> pair_of(int first, int second)
{
    return [=](Trial const& t) {
        int const a = t.stimuli[std::size_t(t.order[0] - 'a')].levels[0];
        int const b = t.stimuli[std::size_t(t.order[1] - 'a')].levels[0];
        return a == first && b == second;
    };
}

TEST(Observer, ChoosesTheBetterOfTwoAsOftenAsItsJodSays)
{
    Script const s = with_block("task: pair, pairs: {factor: q, order: both}");
    ObserverModel m = plain_model(s);
    constexpr int kAsked = 20000;
    EXPECT_NEAR(ask(s, m, kAsked, pair_of(0, 1))("first"), 0.75, near(0.75, kAsked));
    EXPECT_NEAR(ask(s, m, kAsked, pair_of(1, 0))("first"), 0.25, near(0.75, kAsked));
    EXPECT_NEAR(ask(s, m, kAsked, pair_of(0, 2))("first"), phi(2 / kSigma), near(0.9, kAsked));
    m.side_bias = 0.5;
    EXPECT_NEAR(ask(s, m, kAsked, pair_of(1, 0))("first"), phi(-0.5 / kSigma), near(0.4, kAsked));
    m.side_bias = 0;
    m.lapse = 0.4;
    EXPECT_NEAR(ask(s, m, kAsked, pair_of(0, 1))("first"), 0.6 * 0.75 + 0.4 * 0.5, near(0.65, kAsked));
}

TEST(Observer, TiesWhatIsNear)
{
    Script const s = with_block("task: pair, ties: true, pairs: {factor: q, order: both}");
    ObserverModel m = plain_model(s, 0, 0);
    m.tie_width = 0.7;
    double const expected = phi(0.7 / kSigma) - phi(-0.7 / kSigma);
    EXPECT_NEAR(ask(s, m, 20000, pair_of(0, 1))("neither"), expected, near(expected, 20000));
}

TEST(Observer, HasThePsychometricFunctionThatItShould)
{
    struct Case {
        char const* block;
        double guess, level, share;
    };
    std::string const range = "scale: log2, range: [1, 1024], harder: up";
    // Harder upwards: F = 1 - exp(-(threshold / level)^slope), threshold 32, slope 2.
    for (Case const& c : {Case{"task: 2ifc, stimulus_ms: 100", 0.5, 32, 1 - std::exp(-1)},
                          Case{"task: 2ifc, stimulus_ms: 100", 0.5, 64, 1 - std::exp(-0.25)},
                          Case{"task: oddity", 1.0 / 3, 32, 1 - std::exp(-1)},
                          Case{"task: yes_no, stimulus_ms: 100", 0.1, 32, 1 - std::exp(-1)}}) {
        Script const s =
            with_block(std::string(c.block) + ", compare: {vary: n, " + range +
                       "}, cross: [q], procedure: {method: constant, levels: [32], trials_per_level: 4}");
        ObserverModel m = plain_model(s);
        ASSERT_EQ(m.varied.size(), 1u);
        EXPECT_EQ(m.varied[0].threshold, 32);
        m.lapse = 0.06;
        auto const is_signal = [](Trial const& t) { return !t.is_noise; };
        Shares const shares = ask(s, m, 10000, is_signal, c.level);
        double const expected = c.guess + (1 - c.guess - 0.06) * c.share;
        EXPECT_NEAR(shares("right"), expected, near(expected, shares.n)) << c.block << " " << c.level;
    }
}

TEST(Observer, RaisesFalseAlarms)
{
    Script const s =
        with_block("task: yes_no, stimulus_ms: 100, compare: {vary: n, scale: linear, range: [0, 10], harder: "
                   "down}, cross: [q], procedure: {method: constant, levels: [5], trials_per_level: 4}");
    ObserverModel m = plain_model(s);
    m.false_alarms = 0.2;
    Shares const noise = ask(s, m, 5000, [](Trial const& t) { return t.is_noise; });
    EXPECT_NEAR(noise("yes"), 0.2, near(0.2, noise.n));
    Shares const easy = ask(
        s, m, 1000, [](Trial const& t) { return !t.is_noise; }, 10.0);
    EXPECT_GT(easy("right"), 0.97); // 4 standard deviations above the threshold
}

TEST(Observer, IsAtChanceWhereNothingDiffers)
{
    auto const all = [](Trial const&) { return true; };
    for (auto const& [task, chance] : {std::pair("2ifc, stimulus_ms: 100", 0.5),
                                       std::pair("abx, stimulus_ms: 100", 0.5), std::pair("oddity", 1.0 / 3)}) {
        Script const s = with_block(std::string("task: ") + task +
                                    ", compare: {factor: q, against: reference, omit: [good]}, repeats: 12");
        Shares const same = ask(s, plain_model(s, 0, 0), 2000, all);
        EXPECT_NEAR(same("right"), chance, near(chance, same.n)) << task;
        Shares const far = ask(s, plain_model(s, -12, -14), 200, all);
        EXPECT_GT(far("right"), 0.97) << task;
    }
}

TEST(Observer, RanksAndRatesByQuality)
{
    Script const ranking = with_block("task: ranking, rank: {factor: q}, repeats: 3");
    ObserverModel m = plain_model(ranking, -1, -2);
    m.noise = 0;
    Shares const ranked = ask(ranking, m, 3, [](Trial const&) { return true; });
    EXPECT_EQ(ranked("abc"), 1);

    Script const rating = with_block("task: rating, scale: {min: 1, max: 5}, cross: [q]");
    m = plain_model(rating, -1.25, -3);
    m.noise = 0;
    Observer const o = draw_observer(m, 1, 1);
    Plan const plan = make_plan(rating, 1);
    Progress const progress(rating, plan);
    for (int i = 0; i < 3; ++i) {
        TrialRequest const r = request_of(rating, plan, progress, {i, 1, false, {}});
        Random random = o.random(std::uint64_t(i));
        double const expected[] = {4, 3, 2}; // 4/5 of 1 to 5 is 4.2; each 1.25 JOD is a quarter
        EXPECT_EQ(answer(o, r, random).value, expected[r.stimuli[0].levels[0]]);
    }
}

TEST(Observer, AnswersItemsWithinTheirRange)
{
    Script const s = with_block("task: rating, scale: {min: 1, max: 5}, cross: [q]");
    ObserverModel m = usual_observers(s);
    m.items_missing = 0.1;
    Observer const o = draw_observer(m, 3, 2);
    Random random(1);
    int missing = 0;
    for (Questionnaire const& q : known_questionnaires())
        for (int i = 0; i < 50; ++i) {
            QuestionnaireDone done;
            answer_items(o, q, random, done);
            EXPECT_NO_THROW(score(q, done.answers));
            missing += int(std::count(done.answers.begin(), done.answers.end(), std::nullopt));
        }
    EXPECT_GT(missing, 100);
}

TEST(Observer, DiffersFromOthersAsMuchAsTheModelSays)
{
    Script const s = with_block("task: pair, pairs: {factor: q}");
    ObserverModel m = plain_model(s);
    m.between_sd = 0.5;
    double sum = 0, squares = 0;
    constexpr int kPeople = 2000;
    for (int p = 1; p <= kPeople; ++p) {
        double const d = draw_observer(m, 9, p).quality({1}) + 1;
        sum += d;
        squares += d * d;
    }
    EXPECT_NEAR(sum / kPeople, 0, 4.5 * 0.5 / std::sqrt(kPeople));
    EXPECT_NEAR(std::sqrt(squares / kPeople), 0.5, 0.04);
    EXPECT_EQ(draw_observer(m, 9, 7).quality({1}), draw_observer(m, 9, 7).quality({1}));
    EXPECT_NE(draw_observer(m, 9, 7).quality({1}), draw_observer(m, 10, 7).quality({1}));
}

TEST(ObserverFile, ChangesWhatItNames)
{
    Script const s = parse_script(file_text(LIGHTWELL_SOURCE_DIR "/data/study/visibility2026.yaml"), "v.yaml");
    ObserverModel const usual = usual_observers(s);
    EXPECT_EQ(usual.quality[1], (std::vector<double>{0, -0.5, -1, -1.5, -2, -2.5}));
    EXPECT_TRUE(usual.quality[0].empty());
    EXPECT_NEAR(usual.varied[0].threshold, 1024, 1e-9);
    ObserverModel const m =
        read_observers(file_text(LIGHTWELL_SOURCE_DIR "/data/observers/visibility2026.yaml"), "o.yaml", s);
    EXPECT_EQ(m.quality[1], (std::vector<double>{0, -0.2, -0.7, -1.6, -1.1, -2.6}));
    EXPECT_EQ(m.render_ms[1][0], 42);
    EXPECT_EQ(m.varied[0].threshold, 900);
    EXPECT_EQ(m.dropped, 0.015);
    EXPECT_EQ(m.side_bias, usual.side_bias);
}

TEST(ObserverFile, SaysWhatIsWrongAndWhere)
{
    Script const s = with_block("task: pair, pairs: {factor: q}");
    auto const message = [&](std::string const& text) -> std::string {
        try {
            read_observers(text, "o.yaml", s);
        } catch (gi::InputError const& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_TRUE(message("lapse: 0.1\nnoize: 2\n").starts_with("o.yaml:2:1: "))
        << message("lapse: 0.1\nnoize: 2\n");
    EXPECT_NE(message("noize: 2\n").find("unknown key 'noize' in observer"), std::string::npos);
    EXPECT_NE(message("noise: loud").find("observer.noise is not a number"), std::string::npos);
    EXPECT_NE(message("quality: {q: {goood: 1}}").find("did you mean 'good'?"), std::string::npos);
    EXPECT_NE(message("lapse: 2"), "");
    EXPECT_NE(message("rating: {best: high}"), "");
    EXPECT_NE(message("varied: {n: {threshold: 3}}"), "");
    EXPECT_NE(message("quality: 3"), "");
    EXPECT_NE(message(""), "");
    EXPECT_EQ(message("{}"), "");
}

TEST(SimulatedTruth, IsThatOfEveryParticipant)
{
    Script const s = with_block("task: pair, pairs: {factor: q}");
    ObserverModel m = plain_model(s);
    m.between_sd = 0.3;
    auto const j = nlohmann::json::parse(truth_text(s, m, 7));
    EXPECT_EQ(j.at("quality_jod").at("q").at("worst"), -2);
    ASSERT_EQ(j.at("participants").size(), 24u);
    EXPECT_EQ(j.at("participants")[4].at("quality_jod").at("q").at("bad").get<double>(),
              draw_observer(m, 7, 5).quality({1}));
}

} // namespace
} // namespace study::test
