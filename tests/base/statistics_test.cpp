// The judges judged: known values, and samplers that are wrong must be caught.

#include "gi/core/rng.h"
#include "tests/support/sphere_chi2.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

TEST(Statistics, TailsHaveTheirTabulatedValues)
{
    EXPECT_NEAR(chi_square_tail(3.841459, 1), 0.05, 1e-6);
    EXPECT_NEAR(chi_square_tail(18.307038, 10), 0.05, 1e-6);
    EXPECT_NEAR(chi_square_tail(135.806723, 100), 0.01, 1e-6);
    EXPECT_NEAR(chi_square_tail(2, 2), std::exp(-1.0), 1e-12);
    EXPECT_NEAR(chi_square_tail(4000, 4000), 0.497, 1e-3);
    EXPECT_EQ(chi_square_tail(0, 5), 1);
    EXPECT_NEAR(normal_cdf(0), 0.5, 1e-15);
    EXPECT_NEAR(normal_cdf(1.959964), 0.975, 1e-6);
    EXPECT_NEAR(normal_cdf(-3), 0.001349898, 1e-9);
    EXPECT_NEAR(sidak_level(0.01, 1), 0.01, 1e-15);
    EXPECT_NEAR(1 - std::pow(1 - sidak_level(0.01, 50), 50), 0.01, 1e-12);
}

TEST(Statistics, SmallBinsArePooledAndImpossibleOnesCount)
{
    // Groups of 4 + 4, 4 + 4 and 4 + 100.
    double const statistic = 16.0 / 8 + 16.0 / 8 + 64.0 / 104;
    EXPECT_NEAR(chi_square_p({6, 6, 6, 6, 6, 90}, {4, 4, 4, 4, 4, 100}), chi_square_tail(statistic, 2), 1e-12);
    EXPECT_EQ(chi_square_p({50, 50, 1}, {50, 51, 0}), 0);
}

TEST(Statistics, RunningMeanIsMeanAndStandardError)
{
    RunningMean m;
    for (double const x : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) m.add(x);
    EXPECT_NEAR(m.mean(), 5, 1e-12);
    EXPECT_NEAR(m.sigma(), std::sqrt(32.0 / 7 / 8), 1e-12);
}

/// cos / pi about +z, drawn by rejection; `share` of the samples is uniform instead.
SphereChi2 cosine_test(double share, std::uint64_t seed)
{
    Pcg32 rng(seed, 0);
    auto const draw = [&]() -> std::optional<vec3> {
        bool const spoilt = rng.uniform_double() < share;
        double const u = rng.uniform_double(), z = spoilt ? u : std::sqrt(u),
                     phi = 6.283185307 * rng.uniform_double();
        return vec3(dvec3{std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z});
    };
    return test_sampler(
        {}, draw, [](vec3 d) { return std::max(0.0, double(d.z)) / glm::pi<double>(); }, 150000);
}

TEST(SphereChi2, AcceptsARightSamplerAndCatchesOneThatIsSlightlyWrong)
{
    SphereChi2 const right = cosine_test(0, 31);
    EXPECT_GT(right.p, 0.01);
    EXPECT_NEAR(right.integral, 1, 1e-6);
    EXPECT_LT(cosine_test(0.05, 31).p, 1e-6);
}

TEST(SphereBins, DirectionsFallIntoTheirBins)
{
    for (int const focus : {1, 4}) {
        SphereBins bins;
        bins.focus = focus;
        bins.frame = Frame::about(glm::normalize(vec3{1, -2, 0.5f}));
        // The innermost bins of a focused grid are smaller than what a float direction resolves.
        for (int row = focus == 1 ? 0 : 4; row < bins.rows; ++row)
            for (int column = 0; column < bins.columns; ++column) {
                vec3 const d = bins.direction((row + 0.5) / bins.rows, (column + 0.5) / bins.columns);
                EXPECT_EQ(bins.bin_of(d), std::size_t(row * bins.columns + column)) << focus;
            }
        EXPECT_NEAR(integrate_all(
                        bins, [](vec3) { return 1.0; }, 1e-6),
                    4 * glm::pi<double>(), 1e-5);
        EXPECT_NEAR(integrate_all(
                        bins, [](vec3 d) { return double(d.y * d.y); }, 1e-6),
                    4 * glm::pi<double>() / 3, 1e-4);
    }
}

} // namespace
} // namespace gi::test
