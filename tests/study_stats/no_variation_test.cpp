// Data without variation but for rounding, of any size, and far from 0.

#include "study/stats/agreement.h"
#include "study/stats/bootstrap.h"
#include "study/stats/effect_size.h"
#include "study/stats/mixed_anova.h"
#include "study/stats/ratings.h"
#include "study/stats/summary.h"

#include <cmath>
#include <gtest/gtest.h>

namespace study::test {
namespace {

constexpr double kSizes[]{1e-12, 1, 1e12};

Matrix table(std::size_t observers, std::size_t cells, auto const& value)
{
    Matrix m(observers, cells);
    for (std::size_t o = 0; o < observers; ++o)
        for (std::size_t c = 0; c < cells; ++c) m(o, c) = value(double(o), double(c));
    return m;
}

TEST(Summary, OfEqualValuesIsExact)
{
    for (double const v : {0.1, 1e-12 / 3, 1e12 / 7, -1e9 / 3}) {
        std::vector<double> const values(1000, v);
        EXPECT_EQ(mean(values), v);
        EXPECT_EQ(standard_deviation(values), 0);
    }
    EXPECT_EQ(standard_deviation(std::vector<double>{20.1 - 10.1, 10, 30.3 - 20.3}, 30.3), 0) << "rounding";
    EXPECT_NEAR(standard_deviation(std::vector<double>{1e9, 1e9 + 1, 1e9 + 2}), 1, 1e-12);
    EXPECT_NEAR(standard_deviation(std::vector<double>{1e12, 1e12 + 1, 1e12 + 2}), 1, 1e-12) << "no rounding";
    EXPECT_TRUE(std::isnan(mean(std::vector<double>{})));
}

TEST(MixedAnova, OfConstantDifferencesTestsNothing)
{
    for (double const size : kSizes)
        for (double const step : {1.0, 0.1, 1.0 / 3}) {
            auto const all =
                mixed_anova(table(5, 3, [&](double o, double c) { return size * (10 * step * o + step * c * c); }),
                            {{{"item", 3}}, {}}, {.permutations = 19});
            ASSERT_EQ(all.size(), 1u);
            EXPECT_FALSE(all[0].is_tested) << size << " " << step << " F " << all[0].f;
            EXPECT_TRUE(std::isnan(all[0].p) && std::isnan(all[0].f) && std::isnan(all[0].eta2.low));
        }
}

TEST(MixedAnova, TestsTheEffectsThatVaryAndSaysWhichDoNot)
{
    // Items differ by constants; groups differ, and people in them.
    auto const all = mixed_anova(table(6, 2, [](double o, double c) { return 0.1 * o * o + 3 * c; }),
                                 {{{"item", 2}}, {{"group", 2, {0, 0, 0, 1, 1, 1}}}});
    bool has_group = false, has_item = false;
    for (AnovaEffect const& e : all) {
        if (e.name == "group") has_group = e.is_tested && e.f > 1;
        if (e.name == "item") has_item = !e.is_tested;
        EXPECT_NE(e.name, "group x item") << "no effect and no error: there is none";
    }
    EXPECT_TRUE(has_group && has_item);
}

TEST(MixedAnova, OfDataOfAnySizeAndFarFromZeroIsTheSame)
{
    double const noise[]{0.3, -0.2, 0.5, 0.1, -0.6, 0.4, 0.2, -0.1, 0.7, -0.3};
    auto const f = [&](double size, double offset) {
        auto const all = mixed_anova(
            table(5, 2, [&](double o, double c) { return offset + size * (c + noise[int(2 * o + c)]); }),
            {{{"item", 2}}, {}});
        return all.at(0).f;
    };
    // t test of the differences 0.5, 0.6, 2.0, 0.7, 0 (noise of c = 1 minus that of c = 0, plus 1).
    std::vector<double> const d{0.5, 0.6, 2.0, 0.7, 0.0};
    double const t = mean(d) / (standard_deviation(d) / std::sqrt(5.0));
    EXPECT_NEAR(f(1, 0), t * t, 1e-12);
    for (double const size : kSizes) EXPECT_NEAR(f(size, 0) / (t * t), 1, 1e-9) << size;
    EXPECT_NEAR(f(1, 1e9) / (t * t), 1, 1e-6);
    EXPECT_NEAR(f(1, -1e12) / (t * t), 1, 1e-3);
}

TEST(Welch, OfGroupsWithoutVariationIsRefused)
{
    for (double const size : kSizes) {
        std::vector<double> const a(4, 0.1 * size), b{0.3 * size, 0.1 * size + 0.2 * size, 0.3 * size};
        EXPECT_THROW(welch_test(a, b), std::invalid_argument) << size << ": 0.1 + 0.2 is 0.3 but for rounding";
    }
    std::vector<double> const a{1e9, 1e9 + 1, 1e9 + 2}, b{1e9 + 3, 1e9 + 4, 1e9 + 5};
    EXPECT_NEAR(welch_test(a, b).t, -3 / std::sqrt(2.0 / 3), 1e-9);
}

TEST(MeanOpinions, WithoutVariationHaveNoInterval)
{
    Matrix m(2, 4, 0.1);
    m(1, 0) = 0.1 + 1e-6;
    auto const all = mean_opinions(m);
    EXPECT_EQ(all[0].mean, 0.1);
    EXPECT_EQ(all[0].deviation, 0);
    EXPECT_TRUE(std::isnan(all[0].interval.low) && std::isnan(all[0].skewed.high));
    EXPECT_GT(all[1].interval.high, all[1].mean);
}

TEST(RatingModel, IsTheSameForDataOfAnySizeAndFarFromZero)
{
    double const noise[]{0.3, -0.2, 0.5, 0.1, -0.6, 0.4, 0.2, -0.1, 0.7, -0.3, 0.25, -0.45};
    auto const fit = [&](double size, double offset) {
        std::vector<Rating> ratings;
        for (int i = 0; i < 12; ++i)
            ratings.push_back({i % 3, i / 3, offset + size * (i % 3 + 0.5 * (i / 3) + noise[i])});
        return fit_ratings(ratings, 3, 4);
    };
    RatingModel const usual = fit(1, 0);
    for (double const size : kSizes)
        for (std::size_t i = 0; i < 3; ++i) {
            RatingModel const m = fit(size, 0);
            EXPECT_NEAR(m.quality[i] / size, usual.quality[i], 1e-8) << size;
            EXPECT_NEAR(m.quality_error[i] / size, usual.quality_error[i], 1e-8) << size;
        }
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(fit(1, 1e9).quality[i] - 1e9, usual.quality[i], 1e-5);
}

TEST(RatingModel, OfObserversWhoDifferByConstantsHasNoErrors)
{
    for (double const size : kSizes) {
        std::vector<Rating> ratings;
        for (int i = 0; i < 12; ++i) ratings.push_back({i % 3, i / 3, size * (0.1 * (i % 3) + 0.7 * (i / 3))});
        RatingModel const m = fit_ratings(ratings, 3, 4);
        EXPECT_NEAR((m.quality[2] - m.quality[0]) / size, 0.2, 1e-9);
        EXPECT_TRUE(std::isnan(m.quality_error[0]));
        EXPECT_NE(m.note.find("by constants alone"), std::string::npos) << m.note;
    }
    RatingModel const same = fit_ratings(std::vector<Rating>{{0, 0, 4}, {1, 0, 4}, {0, 1, 4}, {1, 1, 4}}, 2, 2);
    EXPECT_EQ(same.quality[0], 4);
    EXPECT_TRUE(std::isnan(same.quality_error[0]));
}

TEST(Midranks, TieWhatIsEqualButForRounding)
{
    EXPECT_EQ(midranks(std::vector<double>{0.3, 0.1 + 0.2, 1}), (std::vector<double>{1.5, 1.5, 3}));
    EXPECT_EQ(midranks(std::vector<double>{1e9, 1e9 + 1e-3}), (std::vector<double>{1, 2}));
    EXPECT_TRUE(friedman(Matrix(4, 3, 0.1)).is_tied);
}

TEST(Bootstrap, OfEqualObserversHasNoInterval)
{
    auto const b = bootstrap(5, [](std::span<int const>) { return std::vector<double>{0.1, 1e-12}; });
    for (Interval const& i : b.interval) EXPECT_TRUE(std::isnan(i.low) && std::isnan(i.high));
}

} // namespace
} // namespace study::test
