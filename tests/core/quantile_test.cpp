// Quantiles beside those of numpy 2.2 (numpy.quantile, its default method "linear").

#include "gi/core/quantile.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

double const kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> falling(int n)
{
    std::vector<double> values;
    for (int i = n; i > 0; --i) values.push_back(i);
    return values;
}

TEST(Quantile, OfOneValueIsThatValue)
{
    for (double const p : {0.0, 0.25, 0.5, 0.99, 1.0}) EXPECT_EQ(quantile(std::vector<double>{3.5}, p), 3.5);
    EXPECT_EQ(median(std::vector<float>{2.5f}), 2.5);
}

TEST(Quantile, OfTwoValuesIsBetweenThem)
{
    std::vector<double> const v{20, 10};
    EXPECT_EQ(quantile(v, 0), 10);
    EXPECT_EQ(quantile(v, 0.25), 12.5);
    EXPECT_EQ(quantile(v, 0.5), 15);
    EXPECT_DOUBLE_EQ(quantile(v, 0.99), 19.9);
    EXPECT_EQ(quantile(v, 1), 20);
}

TEST(Quantile, OfAHundredValuesIsNotTheLargest)
{
    std::vector<double> const v = falling(100); // numpy.quantile(numpy.arange(1, 101), p)
    EXPECT_NEAR(quantile(v, 0.01), 1.99, 1e-12);
    EXPECT_NEAR(quantile(v, 0.25), 25.75, 1e-12);
    EXPECT_EQ(quantile(v, 0.5), 50.5);
    EXPECT_NEAR(quantile(v, 0.95), 95.05, 1e-12);
    EXPECT_NEAR(quantile(v, 0.99), 99.01, 1e-12);
    EXPECT_EQ(quantile(v, 1), 100);
}

TEST(Quantile, OfUnsortedValuesWithDuplicatesIsThatOfNumpy)
{
    std::vector<double> const v{3.5, -1.25, 7, 3.5, 0.5, 3.5, 12.75, 0.5, 9, -4};
    struct {
        double p, numpy;
    } const wanted[] = {{0.05, -2.7625}, {0.1, -1.525}, {0.25, 0.5},  {0.4, 2.3},      {0.5, 3.5},
                        {0.6, 3.5},      {0.75, 6.125}, {0.9, 9.375}, {0.95, 11.0625}, {0.99, 12.4125}};
    for (auto const& [p, numpy] : wanted) EXPECT_NEAR(quantile(v, p), numpy, 1e-12) << p;
    std::vector<double> const same(7, 0.1);
    for (double const p : {0.0, 0.3, 0.5, 0.99, 1.0}) EXPECT_EQ(quantile(same, p), 0.1) << "bit for bit";
    EXPECT_EQ(quantile(std::vector<double>{1, 1, 1, 5}, 0.5), 1);
}

TEST(Quantile, OfSortedValuesIsTheSame)
{
    std::vector<float> const v{4, 1, 3, float(kNan), 2, 2};
    std::vector<float> const sorted = sorted_values(v);
    EXPECT_EQ(sorted, (std::vector<float>{1, 2, 2, 3, 4}));
    for (double p = 0; p <= 1; p += 0.0625) EXPECT_EQ(quantile_of_sorted(sorted, p), quantile(v, p)) << p;
}

TEST(Quantile, IgnoresNanAndHasNoneOfNothing)
{
    EXPECT_EQ(quantile(std::vector<double>{kNan, 1, kNan, 3}, 0.5), 2) << "numpy.nanquantile";
    EXPECT_TRUE(std::isnan(quantile(std::vector<double>{}, 0.5)));
    EXPECT_TRUE(std::isnan(quantile(std::vector<double>{kNan, kNan}, 0)));
    EXPECT_TRUE(std::isnan(quantile_of_sorted(std::vector<double>{}, 1)));
    EXPECT_TRUE(std::isnan(median(std::vector<double>{})));
    EXPECT_EQ(quantile(std::vector<double>{kInfinity, 1, kInfinity}, 0.75), kInfinity) << "numpy: inf - inf, NaN";
    EXPECT_EQ(quantile(std::vector<double>{kInfinity, 1, 2}, 0.25), 1.5);
}

TEST(Quantile, RefusesWhatIsNoShare)
{
    for (double const p : {-0.01, 1.01, 99.0, kNan}) {
        EXPECT_THROW(quantile(std::vector<double>{1, 2}, p), std::invalid_argument) << p;
        EXPECT_THROW(quantile(std::vector<double>{}, p), std::invalid_argument) << p;
        EXPECT_THROW(quantile_of_sorted(std::vector<double>{1}, p), std::invalid_argument) << p;
    }
    EXPECT_THROW(quantile_place(0, 0.5), std::invalid_argument);
}

TEST(WeightedMedian, OfEqualWeightsIsTheMedian)
{
    using Pairs = std::vector<std::pair<double, double>>;
    EXPECT_EQ(weighted_median(Pairs{{3, 2}, {1, 2}, {2, 2}}), 2);
    EXPECT_EQ(weighted_median(Pairs{{4, 1}, {1, 1}, {2, 1}, {3, 1}}), 2.5);
    EXPECT_EQ(weighted_median(Pairs{{1, 1}, {2, 1}, {10, 3}}), 10);
    EXPECT_EQ(weighted_median(Pairs{{1, 5}, {2, 1}, {10, 3}}), 1);
    EXPECT_EQ(weighted_median(Pairs{{7, 0.25}}), 7);
    EXPECT_EQ(weighted_median(Pairs{{kNan, 5}, {2, 1}, {3, 0}, {4, kNan}}), 2);
    EXPECT_TRUE(std::isnan(weighted_median(Pairs{{1, 0}})));
    EXPECT_TRUE(std::isnan(weighted_median(Pairs{})));
}

TEST(Quantile, OfHazenIsMatlabs)
{
    std::vector<double> const values{6, 47, 49, 15, 42, 41, 7, 39, 43, 40, 36}; // numpy 2.2.6, method "hazen"
    EXPECT_NEAR(hazen_quantile(values, 0.25), 20.25, 1e-12);
    EXPECT_NEAR(hazen_quantile(values, 0.75), 42.75, 1e-12);
    EXPECT_EQ(hazen_quantile(values, 0), 6);
    EXPECT_EQ(hazen_quantile(values, 1), 49);
    EXPECT_EQ(hazen_quantile(std::vector<double>{3}, 0.9), 3);
    EXPECT_TRUE(std::isnan(hazen_quantile(std::vector<double>{}, 0.5)));
    EXPECT_THROW(hazen_quantile(values, 1.1), std::invalid_argument);
}

} // namespace
} // namespace gi::test
