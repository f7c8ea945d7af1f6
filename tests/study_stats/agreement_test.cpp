// Triads, agreement, equality and outliers against R's eba and pwcmp.

#include "study/stats/agreement.h"
#include "study/stats/outliers.h"
#include "study/stats/triads.h"

#include "tests/study_stats/support/study_data.h"

#include <cmath>
#include <map>

namespace study::test {
namespace {

TEST(Triads, OfTheDogAreThoseOfKendall)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const e = read_json("classic/classic_expected.json")["dog"];
    CircularTriads const t = circular_triads(read_table("classic/classic_dog.csv"));
    EXPECT_EQ(t.count, int(e["circular_triads"]));
    EXPECT_EQ(t.maximum, int(e["max_triads"]));
    EXPECT_NEAR(1 - double(t.count) / t.maximum, double(e["zeta"]), 1e-12);
}

TEST(Triads, OfAnOrderAreNone)
{
    Matrix order(12, 12);
    for (std::size_t i = 0; i < 12; ++i)
        for (std::size_t j = i + 1; j < 12; ++j) order(i, j) = 1;
    CircularTriads const t = circular_triads(order);
    EXPECT_EQ(t.count, 0);
    EXPECT_EQ(circular_triads(Matrix(1, 1)).maximum, 0);
    EXPECT_THROW(circular_triads(Matrix(2, 2)), std::invalid_argument);
    EXPECT_THROW(circular_triads(Matrix(0, 0)), std::invalid_argument);
}

TEST(Agreement, OfSchoolchildrenIsThatOfKendall)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const expected = read_json("classic/classic_expected.json");
    for (std::string const name : {"school_boys", "school_girls", "taste"}) {
        Matrix const wins = read_table("classic/classic_" + name + ".csv");
        auto const& a = expected[name]["agreement"];
        KendallU const k = kendall_u(wins);
        EXPECT_EQ(k.observers, int(a["n_observers"]));
        EXPECT_EQ(k.items, int(a["n_items"]));
        EXPECT_NEAR(k.u, double(a["u"]), 1e-6);
        EXPECT_NEAR(k.minimum, double(a["u_min"]), 1e-6);
        EXPECT_NEAR(k.chi_square, double(a["chi2_uncorrected"]), 1e-6);
        EXPECT_NEAR(k.chi_square_corrected, double(a["chi2_continuity_corrected"]), 1e-6);
        EXPECT_NEAR(k.degrees_of_freedom, double(a["df"]), 1e-6);
        EXPECT_NEAR(k.p / double(a["p_uncorrected"]), 1, 1e-6);
        EXPECT_NEAR(k.p_corrected / double(a["p_corrected"]), 1, 1e-6);

        auto const& q = expected[name]["equality_test"];
        EqualityTest const t = equality_test(wins);
        EXPECT_EQ(t.score, q["scores"].get<std::vector<double>>());
        EXPECT_NEAR(t.d, double(q["D_n"]), 1e-6);
        EXPECT_EQ(t.degrees_of_freedom, int(q["df"]));
        EXPECT_NEAR(t.p / double(q["p"]), 1, 1e-6);
        EXPECT_NEAR(t.studentized_range, double(q["studentized_range_q05"]), 1e-6);
        EXPECT_NEAR(t.range, double(q["score_range_critical_R"]), 1e-6);
    }
}

TEST(Agreement, IsOneAmongThoseWhoAgreeAndUndefinedForOne)
{
    Matrix wins(3, 3);
    wins(0, 1) = wins(0, 2) = wins(1, 2) = 2;
    EXPECT_EQ(kendall_u(wins).u, 1);
    EXPECT_TRUE(std::isnan(kendall_u(wins).chi_square)); // two observers: no test
    wins(0, 1) = 1;
    EXPECT_THROW(kendall_u(wins), std::invalid_argument); // one pair judged by fewer
    wins(0, 2) = wins(1, 2) = 1;
    EXPECT_THROW(kendall_u(wins), std::invalid_argument); // one observer
    EXPECT_EQ(equality_test(wins).d, 4 * (4 + 1 - 3.0) / 3);
    EXPECT_THROW(kendall_u(Matrix(0, 0)), std::invalid_argument);
    wins(0, 1) = NAN;
    EXPECT_THROW(equality_test(wins), std::invalid_argument);
}

TEST(Friedman, OfAPublishedExample)
{
    // Conover 1999, "Practical Nonparametric Statistics", 5.8 example 1: 12 home owners rank 4 grasses.
    double const ranks[12][4] = {{4, 3, 2, 1},     {4, 2, 3, 1}, {3, 1.5, 1.5, 4}, {3, 1, 2, 4},
                                 {4, 2, 1, 3},     {2, 2, 2, 4}, {1, 3, 2, 4},     {2, 4, 1, 3},
                                 {3.5, 1, 2, 3.5}, {4, 1, 3, 2}, {4, 2, 3, 1},     {3.5, 1, 2, 3.5}};
    Matrix values(12, 4);
    for (std::size_t r = 0; r < 12; ++r)
        for (std::size_t c = 0; c < 4; ++c) values(r, c) = ranks[r][c];
    Friedman const f = friedman(values);
    EXPECT_NEAR(f.chi_square, 8.0973, 5e-5);
    EXPECT_NEAR(f.p, 0.044, 5e-4);
    EXPECT_EQ(f.degrees_of_freedom, 3);
}

TEST(Friedman, WithoutDifferencesIsNoughtAndWithMissingValuesLeavesOut)
{
    Matrix values(3, 3, 4);
    Friedman const same = friedman(values);
    EXPECT_EQ(same.chi_square, 0);
    EXPECT_EQ(same.p, 1);
    EXPECT_EQ(same.kendall_w, 0);
    for (std::size_t o = 0; o < 3; ++o)
        for (std::size_t c = 0; c < 3; ++c) values(o, c) = double(c);
    EXPECT_NEAR(friedman(values).kendall_w, 1, 1e-12);
    values(1, 1) = NAN;
    EXPECT_EQ(friedman(values).left_out, 1);
    EXPECT_EQ(friedman(values).observers, 2);
    EXPECT_THROW(friedman(Matrix(0, 3)), std::invalid_argument);
    EXPECT_THROW(friedman(Matrix(3, 1)), std::invalid_argument);
}

TEST(Outliers, AreThoseOfPwcmp)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const trials = read_csv("pairs_tmo_video.csv");
    std::map<std::string, std::size_t> item, scene, observer;
    for (std::size_t r = 1; r < trials.size(); ++r) {
        observer.emplace(trials[r][0], observer.size());
        scene.emplace(trials[r][2], scene.size());
        item.emplace(trials[r][3], item.size());
        item.emplace(trials[r][4], item.size());
    }
    ASSERT_EQ(observer.size(), 18u);
    std::vector<std::vector<Matrix>> wins(scene.size(),
                                          std::vector<Matrix>(observer.size(), Matrix(item.size(), item.size())));
    for (std::size_t r = 1; r < trials.size(); ++r) {
        std::size_t const a = item.at(trials[r][3]), b = item.at(trials[r][4]);
        Matrix& m = wins[scene.at(trials[r][2])][observer.at(trials[r][0])];
        (trials[r][5] == "1" ? m(a, b) : m(b, a)) += 1;
    }
    // SOURCES.md beside the data has these, of pw_outlier_analysis.m.
    std::map<std::string, double> const expected{
        {"bab", 4.4665}, {"M02", 3.4505}, {"M06", 0.8786}, {"F01", 0.3535}};
    auto const fits = observer_outliers(wins);
    for (auto const& [name, index] : observer)
        EXPECT_NEAR(fits[index].outlier_score, expected.contains(name) ? expected.at(name) : 0, 1e-3) << name;
}

TEST(Outliers, OfFewerThanThreeAreRefused)
{
    EXPECT_THROW(observer_outliers({}), std::invalid_argument);
    EXPECT_THROW(observer_outliers({{Matrix(2, 2), Matrix(2, 2)}}), std::invalid_argument);
    EXPECT_THROW(observer_outliers({{Matrix(2, 2), Matrix(2, 2), Matrix(3, 3)}}), std::invalid_argument);
}

} // namespace
} // namespace study::test
