// Scores of paired comparisons against R (BradleyTerry2, eba, glm), choix and pwcmp.

#include "study/numeric/special.h"
#include "study/stats/distance_prior.h"
#include "study/stats/pair_scale.h"

#include "study/numeric/random.h"
#include "tests/study_stats/support/study_data.h"

#include <cmath>
#include <map>

namespace study::test {
namespace {

PairScale fit(Matrix const& wins, PairModel model)
{
    return fit_pairs(pairs_of(wins), int(wins.rows), {.model = model});
}

Matrix table_of(nlohmann::json const& rows)
{
    Matrix m(rows.size(), rows.size());
    for (std::size_t r = 0; r < m.rows; ++r)
        for (std::size_t c = 0; c < m.columns; ++c) m(r, c) = rows[r][c];
    return m;
}

std::vector<double> times(std::vector<double> values, double factor)
{
    for (double& v : values) v *= factor;
    return values;
}

void expect_scale(PairScale const& scale, nlohmann::json const& e, double tolerance, std::string const& what)
{
    expect_near(scale.score, e["scale_mean0"], tolerance, what + " score");
    expect_near(scale.standard_error, e["se_mean0"], tolerance, what + " standard error");
    std::vector<double> from_first = scale.score;
    for (double& s : from_first) s -= scale.score[0];
    expect_near(from_first, e["scale_first0"], tolerance, what + " from the first");
    EXPECT_NEAR(scale.deviance, double(e["deviance"]), tolerance) << what;
    EXPECT_EQ(scale.degrees_of_freedom, int(e["df"])) << what;
    EXPECT_NEAR(scale.log_likelihood, double(e["logLik"]), tolerance) << what;
    if (!e.contains("jod_mean0")) return;
    double const jod = jod_per_unit(scale.model);
    expect_near(times(scale.score, jod), e["jod_mean0"], tolerance, what + " JOD");
    expect_near(times(scale.standard_error, jod), e["jod_se_mean0"], tolerance, what + " JOD standard error");
}

TEST(PairScale, OfClassicTablesIsThatOfR)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const expected = read_json("classic/classic_expected.json");
    for (std::string const name : {"school_boys", "school_girls", "taste", "citations"}) {
        Matrix const wins = read_table("classic/classic_" + name + ".csv");
        expect_scale(fit(wins, PairModel::bradley_terry), expected[name]["bradley_terry"], 1e-6, name + " BT");
        expect_scale(fit(wins, PairModel::thurstone_v), expected[name]["thurstone_case5"], 1e-6, name + " V");
    }
    // As published from the rounded tables: Stigler's citations, with the error of the first difference.
    PairScale const citations = fit(read_table("classic/classic_citations.csv"), PairModel::bradley_terry);
    EXPECT_NEAR(difference(citations, 1, 0).standard_error, 0.102545, 1e-6);
}

TEST(PairScale, HasAnOrderEffect)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const expected = read_json("classic/classic_expected.json")["baseball"];
    std::map<std::string, int> team;
    for (std::string const t : expected["no_order_effect"]["teams"]) team.emplace(t, int(team.size()));
    std::vector<PairCount> games;
    auto const rows = read_csv("classic/classic_baseball.csv");
    for (std::size_t r = 1; r < rows.size(); ++r)
        games.push_back({team.at(rows[r][0]), team.at(rows[r][1]), std::stod(rows[r][2]), std::stod(rows[r][3])});

    PairScale const plain = fit_pairs(games, 7, {.model = PairModel::bradley_terry});
    auto const& p = expected["no_order_effect"];
    PairScale const home = fit_pairs(games, 7, {.model = PairModel::bradley_terry, .order = OrderEffect::fitted});
    auto const& h = expected["with_order_effect"];
    for (int t = 1; t < 7; ++t) {
        auto const i = std::size_t(t);
        EXPECT_NEAR(difference(plain, t, 0).value, double(p["ability"][i]), 1e-6);
        EXPECT_NEAR(difference(plain, t, 0).standard_error, double(p["se"][i]), 1e-6);
        EXPECT_NEAR(difference(home, t, 0).value, double(h["estimate"][i - 1]), 1e-6);
        EXPECT_NEAR(difference(home, t, 0).standard_error, double(h["se"][i - 1]), 1e-6);
    }
    EXPECT_NEAR(plain.deviance, double(p["deviance"]), 1e-6);
    EXPECT_EQ(plain.degrees_of_freedom, int(p["df"]));
    ASSERT_TRUE(home.order);
    EXPECT_NEAR(home.order->value, double(h["estimate"][6]), 1e-6);
    EXPECT_NEAR(home.order->standard_error, double(h["se"][6]), 1e-6);
    EXPECT_NEAR(home.deviance, double(h["deviance"]), 1e-6);
    EXPECT_EQ(home.degrees_of_freedom, int(h["df"]));
}

TEST(PairScale, OfToneMappersIsThatOfRAndPwcmp)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const expected = read_json("pairs_tmo_video.expected.json");
    EXPECT_EQ(expected.size(), 6u);
    auto const trials = read_csv("pairs_tmo_video.csv");
    for (auto const& [scene, e] : expected.items()) {
        std::map<std::string, std::size_t> item;
        for (std::string const label : e["labels"]) item.emplace(label, item.size());
        Matrix wins(7, 7);
        int count = 0;
        for (std::size_t r = 1; r < trials.size(); ++r) {
            if (scene != "all" && trials[r][2] != scene) continue;
            std::size_t const a = item.at(trials[r][3]), b = item.at(trials[r][4]);
            (trials[r][5] == "1" ? wins(a, b) : wins(b, a)) += 1;
            ++count;
        }
        EXPECT_EQ(count, int(e["n_comparisons"]));
        EXPECT_EQ(wins.values, table_of(e["wins"]).values);
        expect_scale(fit(wins, PairModel::bradley_terry), e["bradley_terry"], 1e-4, scene + " BT");
        expect_scale(fit(wins, PairModel::thurstone_v), e["thurstone_case5"], 1e-4, scene + " V");
        expect_near(scale_with_distance_prior(wins), e["pwcmp_gaussian_prior_jod"], 1e-3, scene + " prior");
    }
}

TEST(PairScale, WithTheDistancePriorMaximisesWhatItSays)
{
    // The definition of distance_prior.h in numpy, maximised by scipy's BFGS and Nelder & Mead's method.
    Matrix wins(6, 6);
    wins.values = {0, 7, 9, 10, 0, 9, 3, 0, 6, 8, 9, 10, 1, 4, 0, 6, 7, 0, //
                   0, 2, 4, 0,  6, 8, 0, 1, 3, 4, 0, 5,  1, 0, 0, 2, 5, 0};
    expect_near(scale_with_distance_prior(wins),
                {1.61138204, 0.84232427, 0.03417604, -0.41663859, -0.91326492, -1.15797884}, 1e-6, "score");

    // Most pairs unanimous: beyond the maximum there is a way to infinity.
    Matrix unanimous(7, 7);
    unanimous.values = {0,  0,  0,  3, 0,  15, 0, 16, 0,  0,  14, 3,  16, 0, 16, 16, 0,     //
                        16, 15, 16, 0, 13, 2,  0, 0,  0,  16, 0,  16, 13, 1, 16, 0,  16, 0, //
                        1,  0,  0,  0, 0,  0,  0, 16, 16, 16, 16, 16, 16, 0};
    expect_near(scale_with_distance_prior(unanimous),
                {-2.73708366, -0.1148997, 2.62834654, -1.49710014, 1.14059874, -4.54772316, 5.12786139}, 1e-6,
                "of nearly unanimous choices");
}

TEST(PairScale, MeetsTheCasesOfChoix)
{
    LIGHTWELL_NEED_STUDY_DATA();
    for (std::string const name : {"choix/testcase-pairwise-1.json", "choix/testcase-pairwise-2.json"}) {
        auto const e = read_json(name);
        Matrix wins(e["n_items"], e["n_items"]);
        for (auto const& [winner, loser] : e["data"].get<std::vector<std::pair<int, int>>>())
            wins(std::size_t(winner), std::size_t(loser)) += 1;
        expect_near(fit(wins, PairModel::bradley_terry).score, e["ml_est"], 1e-5, name);
    }
}

/// Trials of a simulated observer with these scores, order effect and threshold, over all ordered pairs.
std::vector<PairCount> simulated(std::vector<double> const& score, double order, double threshold, int repeats)
{
    Random random(3);
    std::vector<PairCount> pairs;
    for (int i = 0; i < int(score.size()); ++i)
        for (int j = 0; j < int(score.size()); ++j) {
            if (i == j) continue;
            PairCount pair{i, j};
            for (int k = 0; k < repeats; ++k) {
                double const x = score[std::size_t(i)] - score[std::size_t(j)] + order + random.normal();
                (x > threshold ? pair.first_wins : x < -threshold ? pair.second_wins : pair.ties) += 1;
            }
            pairs.push_back(pair);
        }
    return pairs;
}

TEST(PairScale, FindsOrderEffectAndThresholdOfTiesAgain)
{
    auto const pairs = simulated({-0.6, 0.1, 0.5}, 0.3, 0.4, 3000);
    PairScale const s = fit_pairs(pairs, 3, {.order = OrderEffect::fitted, .ties = TieModel::threshold});
    std::vector<double> const truth{-0.6, 0.1, 0.5};
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(s.score[i], truth[i], 4 * s.standard_error[i]);
    ASSERT_TRUE(s.order && s.tie_threshold);
    EXPECT_NEAR(s.order->value, 0.3, 4 * s.order->standard_error);
    EXPECT_NEAR(s.tie_threshold->value, 0.4, 4 * s.tie_threshold->standard_error);
    EXPECT_EQ(s.degrees_of_freedom, 6 * 2 - 4);
    EXPECT_GT(s.fit_p, 0.001);
    EXPECT_LT(s.standard_error[0], 0.02);
}

TEST(PairScale, TiesThatCountHalfPullTogether)
{
    std::vector<PairCount> const pairs{{0, 1, 6, 2, 4}};
    PairScale const s = fit_pairs(pairs, 2);
    EXPECT_NEAR(s.score[0] - s.score[1], normal_quantile(8.0 / 12), 1e-9);
    std::vector<PairCount> const all_ties{{0, 1, 0, 0, 4}, {1, 2, 0, 0, 4}};
    for (double const score : fit_pairs(all_ties, 3).score) EXPECT_NEAR(score, 0, 1e-12);
    EXPECT_THROW(fit_pairs(all_ties, 3, {.ties = TieModel::threshold}), std::invalid_argument);
    PairScale const none = fit_pairs(std::vector<PairCount>{{0, 1, 6, 2}}, 2, {.ties = TieModel::threshold});
    EXPECT_FALSE(none.tie_threshold);
    EXPECT_NE(none.note, "");
}

TEST(PairScale, IsRegularisedWhereChoicesWereUnanimousAndSaysSo)
{
    // Jeffreys' prior of one proportion under the logistic link: half a choice is added to each side.
    std::vector<PairCount> const one{{0, 1, 7, 0}};
    PairScale const bt = fit_pairs(one, 2, {.model = PairModel::bradley_terry});
    EXPECT_TRUE(bt.regularised);
    EXPECT_NE(bt.note, "");
    EXPECT_NEAR(bt.score[0] - bt.score[1], std::log(7.5 / 0.5), 1e-6);

    for (PairModel const model : {PairModel::thurstone_v, PairModel::bradley_terry}) {
        std::vector<PairCount> const always{{0, 1, 9, 0}, {1, 2, 9, 0}, {0, 2, 9, 0}};
        PairScale const s = fit_pairs(always, 3, {.model = model});
        EXPECT_TRUE(s.regularised);
        EXPECT_EQ(s.note.find("converge"), std::string::npos) << s.note;
        EXPECT_GT(s.score[0], s.score[1]);
        EXPECT_GT(s.score[1], s.score[2]);
        EXPECT_LT(s.score[0], 8);
        EXPECT_NEAR(s.score[1], 0, 1e-6);
        EXPECT_THROW(fit_pairs(always, 3, {.model = model, .regularisation = Regularisation::never}),
                     std::invalid_argument);
        std::vector<PairCount> const first_always{{0, 1, 9, 0}, {1, 0, 9, 0}};
        PairScale const biased = fit_pairs(first_always, 2, {.model = model, .order = OrderEffect::fitted});
        EXPECT_TRUE(biased.regularised);
        EXPECT_NEAR(biased.score[0], 0, 1e-6);
        EXPECT_GT(biased.order->value, 1);
    }
    EXPECT_FALSE(fit_pairs(std::vector<PairCount>{{0, 1, 3, 1}}, 2).regularised);
}

TEST(PairScale, RegularisationTakesBiasAway)
{
    // The mean estimate over all outcomes of 12 trials; Firth 1993: the bias is of second order.
    double const truth = 0.8, p = 1 / (1 + std::exp(-truth));
    double mean = 0;
    for (int k = 0; k <= 12; ++k) {
        std::vector<PairCount> const pair{{0, 1, double(k), 12.0 - k}};
        PairScale const s =
            fit_pairs(pair, 2, {.model = PairModel::bradley_terry, .regularisation = Regularisation::always});
        mean += std::exp(log_choose(12, k)) * std::pow(p, k) * std::pow(1 - p, 12 - k) * (s.score[0] - s.score[1]);
    }
    EXPECT_NEAR(mean, truth, 0.01);
}

TEST(PairScale, OfOneItemIsNought)
{
    PairScale const s = fit_pairs({}, 1);
    EXPECT_EQ(s.score, std::vector<double>{0});
    EXPECT_EQ(s.standard_error, std::vector<double>{0});
    EXPECT_EQ(s.degrees_of_freedom, 0);
}

TEST(PairScale, RefusesWhatCannotBeScaled)
{
    std::vector<PairCount> const apart{{0, 1, 3, 2}, {2, 3, 1, 4}};
    EXPECT_THROW(fit_pairs({}, 0), std::invalid_argument);
    EXPECT_THROW(fit_pairs({}, 2), std::invalid_argument);
    EXPECT_THROW(fit_pairs(apart, 4), std::invalid_argument);
    EXPECT_THROW(fit_pairs(apart, 3), std::invalid_argument);
    EXPECT_THROW(fit_pairs(std::vector<PairCount>{{0, 1, NAN, 2}}, 2), std::invalid_argument);
    EXPECT_THROW(fit_pairs(std::vector<PairCount>{{0, 1, -1, 2}}, 2), std::invalid_argument);
    EXPECT_THROW(fit_pairs(std::vector<PairCount>{{0, 0, 1, 2}}, 2), std::invalid_argument);
    EXPECT_THROW(pairs_of(Matrix(2, 3)), std::invalid_argument);
    EXPECT_THROW(scale_with_distance_prior(Matrix(2, 2)), std::invalid_argument);
    EXPECT_THROW(difference(fit_pairs({}, 1), 0, 1), std::invalid_argument);
}

} // namespace
} // namespace study::test
