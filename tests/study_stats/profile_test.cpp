// The limit of likelihood ratios of means over observers, and rates of several observers.

#include "study/numeric/random.h"
#include "study/numeric/special.h"
#include "study/stats/profile.h"
#include "study/stats/shrunken_rates.h"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace study {
namespace {

/// Twice the greatest log-likelihood of observers' estimates with variance 1 + v, v >= 0, around a mean.
double twice_log_likelihood(double squares_around_mean, double n)
{
    double const variance = std::max(1.0, squares_around_mean / n);
    return -n * std::log(variance) - squares_around_mean / variance;
}

TEST(ProfileLimit, HoldsMeansOfNormalEstimatesWhateverTheirSpread)
{
    constexpr int kExperiments = 20000;
    for (int const n : {3, 8, 20})
        for (double const between : {0.0, 0.15, 0.4, 1.0, 5.0}) {
            Random random(std::uint64_t(10 * n) + std::uint64_t(100 * between));
            int held = 0;
            for (int e = 0; e < kExperiments; ++e) {
                double sum = 0, squares = 0;
                for (int i = 0; i < n; ++i) {
                    double const x = std::sqrt(1 + between) * random.normal();
                    sum += x;
                    squares += x * x;
                }
                double const around = squares - sum * sum / n, model = std::max(1.0, around / n);
                double const loss = twice_log_likelihood(around, n) - twice_log_likelihood(squares, n);
                held += loss < profile_limit(0.95, n, around / n / model);
            }
            EXPECT_NEAR(double(held) / kExperiments, 0.95, 4 * std::sqrt(0.05 * 0.95 / kExperiments))
                << n << " observers, variance between them " << between;
        }
}

TEST(ProfileLimit, OfOneObserverIsThatOfChiSquare) { EXPECT_NEAR(profile_limit(0.95, 1, 0.3), 3.841459, 1e-5); }

TEST(ProfileLimit, HasThePThatExcludesAValueWithItsInterval)
{
    for (double const n : {1.0, 3.0, 20.0})
        for (double const ratio : {0.2, 0.7, 1.0, 1.6})
            for (double const confidence : {0.5, 0.95, 0.999})
                EXPECT_NEAR(profile_p(profile_limit(confidence, n, ratio), n, ratio), 1 - confidence, 1e-9)
                    << n << " observers, ratio " << ratio;
}

TEST(ProfileLimit, TakesTheModelsVarianceWhereNothingIsSurprising)
{
    EXPECT_DOUBLE_EQ(moderated(0.1, 10, 1e-9, 30), 1);
    EXPECT_NEAR(moderated(0.1, 200, 7.5, 30), 0.1, 0.01) << "answers at chance";
    EXPECT_NEAR(moderated(0.1, 10, 7.5, 30), (9 * 0.1 + 1) / 10, 1e-3) << "few observers";
    EXPECT_GT(moderated(0.1, 200, 0.5, 30), 0.4);
}

TEST(ShrunkenRates, AreTheCommonOneWhereObserversDoNotDiffer)
{
    std::vector<RateCount> const counts{{10, 40}, {11, 40}, {9, 40}, {10, 40}};
    for (double const r : shrunken_rates(counts)) EXPECT_NEAR(r, 40.5 / 161, 1e-12);
}

TEST(ShrunkenRates, AreEachOnesOwnWhereTheyDifferMuch)
{
    std::vector<RateCount> const counts{{0, 1000}, {1000, 1000}, {500, 1000}, {0, 0}};
    auto const rates = shrunken_rates(counts);
    EXPECT_NEAR(rates[0], 0, 0.002);
    EXPECT_GT(rates[0], 0);
    EXPECT_NEAR(rates[1], 1, 0.002);
    EXPECT_LT(rates[1], 1);
    EXPECT_NEAR(rates[2], 0.5, 0.002);
    EXPECT_NEAR(rates[3], 0.5, 0.002) << "no trials: the mean";
    EXPECT_THROW(shrunken_rates(std::vector<RateCount>{{0, 0}}), std::invalid_argument);
    EXPECT_THROW(shrunken_rates(std::vector<RateCount>{{3, 2}}), std::invalid_argument);
}

TEST(ShrunkenRates, AreNearerToTheTruthThanEachOnesOwn)
{
    Random random(4);
    double own = 0, shrunken = 0;
    for (int e = 0; e < 300; ++e) {
        std::vector<RateCount> counts;
        std::vector<double> truth;
        for (int o = 0; o < 20; ++o) {
            truth.push_back(1 / (1 + std::exp(0.85 - 0.4 * random.normal())));
            RateCount c{0, 30};
            for (int t = 0; t < 30; ++t) c.yes += random.uniform() < truth.back();
            counts.push_back(c);
        }
        auto const rates = shrunken_rates(counts);
        for (std::size_t o = 0; o < 20; ++o) {
            own += std::pow((counts[o].yes + 0.5) / 31 - truth[o], 2);
            shrunken += std::pow(rates[o] - truth[o], 2);
        }
    }
    EXPECT_LT(shrunken, 0.7 * own);
}

} // namespace
} // namespace study
