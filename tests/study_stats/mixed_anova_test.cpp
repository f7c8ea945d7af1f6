// Analysis of variance and tests of groups. Expected numbers: statsmodels 0.14.4 (type III sums of squares of each
// contrast, AnovaRM) and scipy 1.15.3 on the same table.

#include "study/stats/effect_size.h"
#include "study/stats/mixed_anova.h"

#include "study/numeric/random.h"

#include <cmath>
#include <gtest/gtest.h>

namespace study::test {
namespace {

/// 11 observers in groups of 6 and 5; conditions 3 x 2.
Matrix ratings()
{
    Matrix m(11, 6);
    m.values = {5, 7, 7, 7, 8, 6, 5, 4, 6,  7, 7, 7, 2, 4, 3, 6,  6, 6, 3, 4, 4, 4,
                4, 5, 4, 4, 5, 5, 7, 5, 6,  4, 5, 4, 6, 6, 5, 5,  6, 8, 8, 7, 7, 6,
                7, 8, 8, 6, 6, 7, 7, 8, 10, 8, 6, 7, 8, 8, 9, 10, 6, 6, 7, 6, 6, 7};
    return m;
}
MixedDesign design() { return {{{"scene", 3}, {"light", 2}}, {{"group", 2, {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1}}}}; }
AnovaEffect const& effect(std::vector<AnovaEffect> const& all, std::string const& name)
{
    for (AnovaEffect const& e : all)
        if (e.name == name) return e;
    throw std::runtime_error("no effect " + name);
}
void expect_digits(double value, double expected) { EXPECT_NEAR(value / expected, 1, 1e-10); }

TEST(MixedAnova, HasStatsmodelsNumbers)
{
    auto const all = mixed_anova(ratings(), design());
    ASSERT_EQ(all.size(), 7u);
    AnovaEffect const group = effect(all, "group");
    expect_digits(group.f, 12.63823196814);
    expect_digits(group.p, 0.0061671067828275);
    EXPECT_EQ(group.df2, 9);
    AnovaEffect const scene = effect(all, "scene");
    expect_digits(scene.f, 23.824098977945);
    expect_digits(scene.p, 8.7588535145382e-06);
    expect_digits(scene.greenhouse_geisser, 0.81773652024228);
    expect_digits(scene.p_gg, 4.6248722919093e-05);
    expect_digits(scene.huynh_feldt, 0.97458604495285);
    AnovaEffect const changes = effect(all, "group x scene");
    expect_digits(changes.f, 0.17082917082917);
    expect_digits(changes.p_gg, 0.80249353669273);
    EXPECT_EQ(changes.df1, 2);
    EXPECT_EQ(changes.df2, 18);
    AnovaEffect const both = effect(all, "group x scene x light");
    expect_digits(both.f, 0.025365406043128);
    EXPECT_EQ(both.huynh_feldt, 1) << "1.083 is cut";
    expect_digits(effect(all, "light").f, 0.13926499032882);
    EXPECT_TRUE(std::isnan(group.p_permutation));
}

TEST(MixedAnova, WithoutGroupsIsThatOfRepeatedMeasures)
{
    auto const all = mixed_anova(ratings(), {design().within, {}});
    ASSERT_EQ(all.size(), 3u);
    expect_digits(effect(all, "scene").f, 26.085972850679);
    expect_digits(effect(all, "light").p, 0.69486931233336);
    expect_digits(effect(all, "scene x light").f, 2.2941176470588);
}

TEST(MixedAnova, PermutesWithoutAssumingNormality)
{
    auto const all = mixed_anova(ratings(), design(), {.permutations = 999, .seed = 3});
    EXPECT_NEAR(effect(all, "group").p_permutation, 0.008, 0.008);
    EXPECT_LT(effect(all, "scene").p_permutation, 0.01);
    EXPECT_GT(effect(all, "group x scene x light").p_permutation, 0.8);
}

TEST(MixedAnova, FindsNothingAsOftenAsItShould)
{
    // Rough, unequal variances: 12 and 5 observers whose ratings are cubes of normal numbers.
    int found = 0, permuted = 0, wide = 0;
    for (int s = 0; s < 400; ++s) {
        Random random = Random::part(8, std::uint64_t(s));
        Matrix m(17, 3);
        MixedDesign d{{{"c", 3}}, {{"g", 2, std::vector<int>(17, 0)}}};
        for (std::size_t o = 0; o < 17; ++o) {
            if (o >= 12) d.between[0].level[o] = 1;
            double const own = random.normal();
            for (std::size_t c = 0; c < 3; ++c) m(o, c) = own + std::pow(random.normal(), 3);
        }
        auto const all = mixed_anova(m, d, {.permutations = 199, .seed = std::uint64_t(s)});
        found += effect(all, "g").p < 0.05;
        permuted += effect(all, "g x c").p_permutation < 0.05;
        wide += effect(all, "c").p_permutation < 0.05;
        for (AnovaEffect const& e : all) {
            EXPECT_LE(e.eta2.low, e.partial_eta2);
            EXPECT_LE(e.partial_eta2, e.eta2.high) << "F = " << e.f;
        }
    }
    EXPECT_NEAR(found / 400.0, 0.05, 0.035);
    EXPECT_NEAR(permuted / 400.0, 0.05, 0.035);
    EXPECT_NEAR(wide / 400.0, 0.05, 0.035);
}

TEST(MixedAnova, RefusesWhatItCannotSeparate)
{
    Matrix gap = ratings();
    gap(3, 2) = std::nan("");
    EXPECT_THROW(mixed_anova(gap, design()), std::invalid_argument);
    EXPECT_THROW(mixed_anova(ratings(), {{{"scene", 4}}, {}}), std::invalid_argument);
    MixedDesign twice = design();
    twice.between.push_back(twice.between[0]); // the same groups
    EXPECT_THROW(mixed_anova(ratings(), twice), std::invalid_argument);
    EXPECT_THROW(mixed_anova(Matrix(2, 2, 1), {{{"c", 2}}, {{"g", 2, {0, 1}}}}), std::invalid_argument);
    EXPECT_THROW(mixed_anova(Matrix(8, 2, 1), {{{"c", 2}}, {}}), std::invalid_argument);
}

/// F is huge where all observers give the same answer up to rounding.
TEST(EffectSize, OfHugeRatiosGoesOnAsThatOfLargeOnes)
{
    for (bool const high : {false, true}) {
        auto const rest = [&](double f) {
            Interval const i = eta2_interval(f, 2, 20);
            return 1 - (high ? i.high : i.low);
        };
        EXPECT_NEAR(rest(4.9e5) / rest(5.1e5), 5.1 / 4.9, 0.01);
    }
    EXPECT_NEAR(eta2_interval(1e300, 2, 20).low, 1, 1e-12);
    auto const gap = [](double of) {
        std::vector<double> const a{of, of + 1, of + 2, of + 3}, b{0, 1, 2, 3.1};
        return welch_test(a, b).g;
    };
    for (double const sign : {-1.0, 1.0}) { // t of 1000 at 920
        Interval const below = gap(900 * sign), above = gap(940 * sign);
        EXPECT_NEAR(above.low / below.low, 94.0 / 90, 0.003);
        EXPECT_NEAR(above.high / below.high, 94.0 / 90, 0.003);
    }
    EXPECT_TRUE(std::isfinite(gap(1e14).high));
}

TEST(EffectSize, HasScipysIntervals)
{
    EXPECT_EQ(eta2_interval(3.5, 2, 20).low, 0);
    EXPECT_NEAR(eta2_interval(3.5, 2, 20).high, 0.4794635291865553, 1e-9);
    EXPECT_NEAR(eta2_interval(9, 2, 20).low, 0.10452044786199498, 1e-9);
    EXPECT_NEAR(eta2_interval(9, 2, 20).high, 0.645550421898111, 1e-9);
}

/// Of F that is smaller than chance makes it no noncentrality is the upper end.
TEST(EffectSize, OfSmallRatiosEndsAtTheEstimate)
{
    EXPECT_EQ(eta2_interval(0.0005, 1, 7).high, 0);
    Matrix cells(8, 2);
    for (std::size_t o = 0; o < 8; ++o) {
        cells(o, 0) = double(o % 3);
        cells(o, 1) = cells(o, 0) + (o % 2 ? 1 : -1) + (o == 0 ? 0.01 : 0);
    }
    AnovaEffect const e = mixed_anova(cells, {{{"c", 2}}, {}}).at(0);
    EXPECT_LT(e.f, 0.001);
    EXPECT_GT(e.partial_eta2, 0);
    EXPECT_EQ(e.eta2.low, 0);
    EXPECT_EQ(e.eta2.high, e.partial_eta2);
}

TEST(Welch, HasScipysNumbers)
{
    WelchTest const w = welch_test(std::vector<double>{1, 2, 4, 3, 7}, std::vector<double>{2, 5, 6, 8, 9, 4});
    expect_digits(w.t, -1.5383198108090315);
    expect_digits(w.df, 8.930659674548396);
    expect_digits(w.p, 0.1586121438699559);
    expect_digits(w.interval.low, -5.603834508271446);
    expect_digits(w.interval.high, 1.0705011749381121);
    EXPECT_NEAR(w.hedges_g, -0.8415203754940171, 1e-12);
    EXPECT_NEAR(w.g.low, -1.971352938564793, 1e-9);
    EXPECT_NEAR(w.g.high, 0.329148725708161, 1e-9);
    EXPECT_THROW(welch_test(std::vector<double>{1}, std::vector<double>{2, 3}), std::invalid_argument);
    EXPECT_THROW(welch_test(std::vector<double>{1, 1}, std::vector<double>{3, 3}), std::invalid_argument);
}

} // namespace
} // namespace study::test
