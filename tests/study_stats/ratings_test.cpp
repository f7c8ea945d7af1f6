// Ratings against R and sureal, rankings against choix.

#include "study/stats/agreement.h"
#include "study/stats/rankings.h"
#include "study/stats/ratings.h"
#include "study/stats/summary.h"

#include "study/numeric/random.h"
#include "tests/study_stats/support/study_data.h"

#include <cmath>

namespace study::test {
namespace {

Matrix nflx()
{
    auto const rows = read_csv("ratings_nflx_public.csv");
    Matrix ratings(79, 26, NAN);
    for (std::size_t r = 1; r < rows.size(); ++r)
        ratings(std::stoul(rows[r][0]), std::stoul(rows[r][2].substr(1))) = std::stod(rows[r][3]);
    return ratings;
}

/// One rating per item and observer; NaN = none.
RatingModel fit_table(Matrix const& table)
{
    std::vector<Rating> ratings;
    for (std::size_t j = 0; j < table.rows; ++j)
        for (std::size_t o = 0; o < table.columns; ++o)
            if (!std::isnan(table(j, o))) ratings.push_back({int(j), int(o), table(j, o)});
    return fit_ratings(ratings, int(table.rows), int(table.columns));
}

/// Six observers rate five items twice.
std::vector<Rating> rated_twice()
{
    double const of_observer[6][5][2] = {
        {{2, 2}, {3, 3}, {3, 4}, {5, 5}, {5, 4}}, {{1, 1}, {1, 2}, {2, 2}, {3, 3}, {4, 5}},
        {{1, 2}, {2, 2}, {3, 3}, {3, 3}, {4, 4}}, {{1, 1}, {2, 3}, {3, 4}, {3, 4}, {5, 5}},
        {{1, 2}, {3, 2}, {3, 3}, {4, 4}, {5, 5}}, {{2, 1}, {2, 3}, {2, 3}, {4, 4}, {4, 4}}};
    std::vector<Rating> ratings;
    for (int o = 0; o < 6; ++o)
        for (int j = 0; j < 5; ++j)
            for (double const value : of_observer[o][j]) ratings.push_back({j, o, value});
    return ratings;
}

TEST(Ratings, AreThoseOfR)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const e = read_json("ratings_nflx_public.expected.json");
    Matrix const ratings = nflx();
    std::vector<double> mos, deviation, error, half;
    for (MeanOpinion const& m : mean_opinions(ratings)) {
        EXPECT_EQ(m.observers, int(e["n_subjects"]));
        mos.push_back(m.mean);
        deviation.push_back(m.deviation);
        error.push_back(m.standard_error);
        // Where all agree, Student's formula gives 0, R's t.test refuses ("data are essentially constant"), and so do we.
        EXPECT_EQ(std::isnan(m.interval.low), m.deviation == 0);
        half.push_back(m.deviation == 0 ? 0 : (m.interval.high - m.interval.low) / 2);
    }
    EXPECT_EQ(mos.size(), std::size_t(e["n_assets"]));
    expect_near(mos, e["mos"], 1e-8, "mean");
    expect_near(deviation, e["sd"], 1e-8, "deviation");
    expect_near(error, e["se"], 1e-8, "standard error");
    expect_near(half, e["ci95_t_halfwidth"], 1e-8, "interval");
    EXPECT_NEAR(mean(mos), double(e["mean_mos"]), 1e-8);
    EXPECT_NEAR(mean(error), double(e["mean_se"]), 1e-8);
    Friedman const f = friedman(transposed(ratings));
    EXPECT_NEAR(f.chi_square, double(e["friedman_chi2"]), 1e-8);
    EXPECT_EQ(f.degrees_of_freedom, int(e["friedman_df"]));
    EXPECT_NEAR(f.kendall_w, double(e["kendall_W_ties_corrected"]), 1e-8);
}

TEST(Ratings, ModelFindsBiasAndInconsistencyAgain)
{
    std::size_t const items = 300, observers = 12;
    Random random(17);
    std::vector<double> quality, bias{-0.8, 0.5, 0, 0, 0.3, 0, 0, -0.2, 0, 0.4, 0, -0.2};
    for (std::size_t j = 0; j < items; ++j) quality.push_back(1 + 4 * random.uniform());
    Matrix ratings(items, observers);
    for (std::size_t j = 0; j < items; ++j)
        for (std::size_t o = 0; o < observers; ++o)
            ratings(j, o) = quality[j] + bias[o] + (o == 3 ? 1.5 : 0.4) * random.normal();
    for (std::size_t j = 0; j < items; j += 7) ratings(j, j % observers) = NAN;
    RatingModel const m = fit_table(ratings);
    EXPECT_TRUE(m.converged);
    EXPECT_EQ(m.note, "");
    double squares = 0;
    for (std::size_t o = 0; o < observers; ++o) {
        EXPECT_NEAR(m.bias[o], bias[o], 4 * m.bias_error[o] + 0.02) << o;
        EXPECT_NEAR(m.inconsistency[o] / (o == 3 ? 1.5 : 0.4), 1, 0.2) << o;
    }
    for (std::size_t j = 0; j < items; ++j)
        squares += std::pow((m.quality[j] - quality[j]) / m.quality_error[j], 2);
    EXPECT_NEAR(squares / items, 1, 0.35);
}

TEST(Ratings, ModelOfRealOnesLeansOnThoseWhoAgree)
{
    LIGHTWELL_NEED_STUDY_DATA();
    Matrix const ratings = nflx();
    RatingModel const m = fit_table(ratings);
    EXPECT_TRUE(m.converged);
    double largest = 0;
    auto const mos = mean_opinions(ratings);
    for (std::size_t j = 0; j < 79; ++j) largest = std::max(largest, std::abs(m.quality[j] - mos[j].mean));
    EXPECT_LT(largest, 0.5);
    std::vector<double> const means =
        read_json("ratings_nflx_public.expected.json")["subject_mean"].get<std::vector<double>>();
    // All rated all: the bias is the mean against that of all.
    for (std::size_t o = 0; o < 26; ++o) EXPECT_NEAR(m.bias[o], means[o] - mean(means), 1e-8) << o;
}

TEST(Ratings, ModelOfRepeatedOnesIsThatOfSureal)
{
    // sureal 0.9.0, SubjectMLEModelProjectionSolver.
    RatingModel const m = fit_ratings(rated_twice(), 5, 6);
    EXPECT_TRUE(m.converged);
    EXPECT_FALSE(m.shrunken);
    EXPECT_EQ(m.note, "");
    expect_near(m.quality, {1.448135, 2.310016, 2.910152, 3.705382, 4.542982}, 1e-6, "quality");
    expect_near(m.quality_error, std::vector<double>(5, 0.127652), 1e-6, "its error");
    expect_near(m.bias, {0.616667, -0.583333, -0.283333, 0.116667, 0.216667, -0.083333}, 1e-6, "bias");
    expect_near(m.inconsistency, {0.530104, 0.443475, 0.38675, 0.550968, 0.348654, 0.510669}, 1e-6,
                "inconsistency");
}

TEST(Ratings, ModelLeavesOutObserversWithOneRating)
{
    std::vector<Rating> ratings = rated_twice();
    RatingModel const without = fit_ratings(ratings, 5, 6);
    ratings.push_back({0, 6, 3});
    RatingModel const m = fit_ratings(ratings, 5, 7);
    EXPECT_EQ(m.quality, without.quality);
    EXPECT_EQ(m.note, "1 observer with one rating is left out");
    EXPECT_TRUE(std::isnan(m.bias[6]));
}

TEST(Ratings, ModelMaximisesTheLikelihoodWithGaps)
{
    std::vector<Rating> ratings = rated_twice();
    ratings.pop_back();
    std::erase_if(ratings, [](Rating const& r) { return r.item == 2 && r.observer == 1; });
    RatingModel const m = fit_ratings(ratings, 5, 6);
    // The same likelihood, maximised by scipy's BFGS.
    expect_near(m.quality, {1.45364514, 2.31095861, 3.01548936, 3.68665381, 4.5780477}, 1e-6, "quality");
    expect_near(m.quality_error, {0.12782643, 0.12782643, 0.13955964, 0.12782643, 0.13158922}, 1e-6, "its error");
    expect_near(m.bias, {0.59104106, -0.50732632, -0.30895893, 0.09104107, 0.19104107, -0.05683795}, 1e-6, "bias");
    expect_near(m.inconsistency, {0.54632483, 0.45042, 0.36808653, 0.52871961, 0.35549162, 0.53837877}, 1e-6,
                "inconsistency");
}

TEST(Ratings, ModelOfFewIsShrunkenWhereItWouldFollowOneObserver)
{
    std::vector<Rating> once, all = rated_twice();
    for (std::size_t k = 0; k < all.size(); k += 2) once.push_back(all[k]);
    RatingModel const m = fit_ratings(once, 5, 6);
    EXPECT_TRUE(m.shrunken);
    EXPECT_TRUE(m.converged);
    EXPECT_NE(m.note, "");
    // The same alternation in numpy; by maximum likelihood it ends at the ratings of one observer.
    expect_near(m.quality, {1.31406574, 2.15244919, 2.70044223, 3.65157515, 4.51480102}, 1e-6, "quality");
    expect_near(m.inconsistency, {0.37282264, 0.33635535, 0.35947643, 0.39949522, 0.38138987, 0.45773017}, 1e-6,
                "inconsistency");
}

TEST(Ratings, OfNobodyOrOneAreDefined)
{
    Matrix ratings(3, 2);
    ratings.values = {NAN, NAN, 4, NAN, 4, 4};
    auto const m = mean_opinions(ratings);
    EXPECT_EQ(m[0].observers, 0);
    EXPECT_TRUE(std::isnan(m[0].mean));
    EXPECT_EQ(m[1].mean, 4);
    EXPECT_TRUE(std::isnan(m[1].interval.low));
    EXPECT_EQ(m[2].mean, 4);
    EXPECT_TRUE(std::isnan(m[2].interval.low) && std::isnan(m[2].interval.high)) << "they do not vary";
    EXPECT_TRUE(mean_opinions(Matrix(0, 0)).empty());

    RatingModel const exact = fit_table(ratings);
    EXPECT_NE(exact.note, "");
    EXPECT_TRUE(std::isnan(exact.quality[0]));
    EXPECT_NEAR(exact.quality[1], 4, 1e-9);
    EXPECT_TRUE(exact.shrunken);
    EXPECT_THROW(fit_ratings({}, 2, 2), std::invalid_argument);
    EXPECT_THROW(fit_ratings(std::vector<Rating>{{2, 0, 1}}, 2, 2), std::invalid_argument);
    EXPECT_THROW(fit_ratings(std::vector<Rating>{{0, -1, 1}}, 2, 2), std::invalid_argument);
    ratings(0, 0) = INFINITY;
    EXPECT_THROW(mean_opinions(ratings), std::invalid_argument);
    EXPECT_THROW(fit_table(ratings), std::invalid_argument);
}

double log_likelihood(std::vector<ChoiceAmong> const& choices, std::vector<double> const& score)
{
    double sum = 0;
    for (ChoiceAmong const& c : choices) {
        double total = std::exp(score[std::size_t(c.chosen)]);
        for (int const r : c.rejected) total += std::exp(score[std::size_t(r)]);
        sum += score[std::size_t(c.chosen)] - std::log(total);
    }
    return sum;
}

TEST(Rankings, MeetTheCasesOfChoix)
{
    LIGHTWELL_NEED_STUDY_DATA();
    for (std::string const name : {"rankings-1", "rankings-2", "top1-1", "top1-2", "pairwise-1", "pairwise-2"}) {
        auto const e = read_json("choix/testcase-" + name + ".json");
        std::vector<ChoiceAmong> choices;
        for (auto const& d : e["data"]) {
            if (name.starts_with("top1")) {
                choices.push_back({d[0], d[1].get<std::vector<int>>()});
                continue;
            }
            for (ChoiceAmong const& c : choices_of(d.get<std::vector<int>>())) choices.push_back(c);
        }
        PlackettLuce const p = fit_plackett_luce(choices, e["n_items"]);
        // The numbers of rankings-2 stop 2.7e-5 short of the maximum (the gradient there is 2e-5); choix itself
        // tests all its cases to 1e-4.
        expect_near(p.score, e["ml_est"], name == "rankings-2" ? 1e-4 : 1e-5, name);
        EXPECT_GE(p.log_likelihood, log_likelihood(choices, e["ml_est"]) - 1e-14) << name;
        EXPECT_NEAR(p.log_likelihood, log_likelihood(choices, p.score), 1e-12) << name;
        EXPECT_FALSE(p.regularised) << name;
    }
}

TEST(Rankings, AreRegularisedWhereAllAgreeAndSaySo)
{
    std::vector<ChoiceAmong> choices;
    for (int i = 0; i < 5; ++i)
        for (ChoiceAmong const& c : choices_of(std::vector<int>{2, 0, 1})) choices.push_back(c);
    PlackettLuce const p = fit_plackett_luce(choices, 3);
    EXPECT_TRUE(p.regularised);
    EXPECT_EQ(p.note.find("converge"), std::string::npos);
    EXPECT_GT(p.score[2], p.score[0]);
    EXPECT_GT(p.score[0], p.score[1]);
    EXPECT_LT(p.score[2], 10);
}

TEST(Rankings, OfOneItemAreNoughtAndBadOnesAreRefused)
{
    EXPECT_EQ(fit_plackett_luce({}, 1).score, std::vector<double>{0});
    EXPECT_TRUE(choices_of({}).empty());
    auto const fit = [](std::vector<ChoiceAmong> const& c, int items) { return fit_plackett_luce(c, items); };
    EXPECT_THROW(fit({}, 0), std::invalid_argument);
    EXPECT_THROW(fit({}, 2), std::invalid_argument);
    EXPECT_THROW(fit({{0, {1, 1}}}, 2), std::invalid_argument);
    EXPECT_THROW(fit({{0, {0}}}, 2), std::invalid_argument);
    EXPECT_THROW(fit({{0, {2}}}, 2), std::invalid_argument);
    EXPECT_THROW(fit({{-1, {0}}}, 2), std::invalid_argument);
}

} // namespace
} // namespace study::test
