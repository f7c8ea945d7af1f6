// The sampler against densities whose moments are known, and its diagnostics against arviz.

#include "study/stats/sampler.h"

#include "study/numeric/random.h"

#include <cmath>
#include <gtest/gtest.h>

namespace study::test {
namespace {

double coordinate(std::span<double const> x, std::size_t i) { return x[i]; }

TEST(Sampler, FindsTheMomentsOfACorrelatedNormalDistribution)
{
    // Standard deviations 1 and 20, correlation 0.9.
    auto const density = [](std::span<double const> x, std::span<double> g) {
        double const a = x[0] - 3, b = x[1] / 20, r = 0.9, f = 1 / (1 - r * r);
        g[0] = -f * (a - r * b);
        g[1] = -f * (b - r * a) / 20;
        return -0.5 * f * (a * a - 2 * r * a * b + b * b);
    };
    Draws const d = sample(density, std::vector<double>{0, 0}, {.draws = 1500, .seed = 3});
    Posterior const first = posterior(d, [](auto x) { return coordinate(x, 0); });
    Posterior const second = posterior(d, [](auto x) { return coordinate(x, 1); });
    Posterior const product = posterior(d, [](auto x) { return (x[0] - 3) * x[1] / 20; });
    EXPECT_NEAR(first.mean, 3, 0.15);
    EXPECT_NEAR(first.deviation, 1, 0.1);
    EXPECT_NEAR(first.low, 3 - 1.96, 0.3);
    EXPECT_NEAR(second.mean, 0, 3);
    EXPECT_NEAR(second.deviation, 20, 2);
    EXPECT_NEAR(product.mean, 0.9, 0.15);
    EXPECT_LT(first.convergence.r_hat, 1.01);
    EXPECT_GT(first.convergence.bulk, 400);
    EXPECT_EQ(d.divergences, 0);
    EXPECT_NEAR(d.acceptance, 0.9, 0.06);
}

TEST(Sampler, FindsTheQuantilesOfASkewedDistribution)
{
    // log of a gamma variable of shape 2: density of y is exp(2 y - e^y).
    auto const density = [](std::span<double const> x, std::span<double> g) {
        g[0] = 2 - std::exp(x[0]);
        return 2 * x[0] - std::exp(x[0]);
    };
    Draws const d = sample(density, std::vector<double>{0}, {.draws = 4000, .seed = 5});
    Posterior const p = posterior(d, [](auto x) { return std::exp(x[0]); });
    EXPECT_NEAR(p.mean, 2, 0.06);
    EXPECT_NEAR(p.deviation, std::sqrt(2.0), 0.08);
    EXPECT_NEAR(p.low, 0.2422, 0.03);
    EXPECT_NEAR(p.high, 5.5716, 0.25);
}

TEST(Sampler, TellsHowMuchIsDrawn)
{
    auto const density = [](std::span<double const> x, std::span<double> g) {
        g[0] = -x[0];
        return -0.5 * x[0] * x[0];
    };
    std::vector<double> shares;
    sample(density, std::vector<double>{0},
           {.chains = 3, .warm_up = 20, .draws = 5, .progress = [&](double s) { shares.push_back(s); }});
    ASSERT_EQ(shares.size(), 75u);
    for (std::size_t i = 0; i < shares.size(); ++i) EXPECT_DOUBLE_EQ(shares[i], double(i + 1) / 75);
}

TEST(Sampler, TellsAFunnelThatItCannotFollow)
{
    // Neal 2003: the scale of nine numbers is exp(v / 2), v from N(0, 3^2).
    auto const density = [](std::span<double const> x, std::span<double> g) {
        double const v = x[0];
        double sum = -v * v / 18;
        g[0] = -v / 9;
        for (std::size_t i = 1; i < 10; ++i) {
            g[i] = -x[i] * std::exp(-v);
            sum += -0.5 * x[i] * x[i] * std::exp(-v) - v / 2;
            g[0] += 0.5 * x[i] * x[i] * std::exp(-v) - 0.5;
        }
        return sum;
    };
    Draws const d = sample(density, std::vector<double>(10, 0.0), {.seed = 1});
    SamplerReport report = report_of(d);
    look_at(report, posterior(d, [](auto x) { return x[0]; }).convergence);
    EXPECT_GT(d.divergences + (report.worst_r_hat > 1.01), 0);
    EXPECT_NE(complaint(report, d.chains), "");
}

TEST(Sampler, RepeatsWithTheSameSeedAndRefusesWhatHasNoStart)
{
    auto const normal = [](std::span<double const> x, std::span<double> g) {
        g[0] = -x[0];
        return -0.5 * x[0] * x[0];
    };
    std::vector<double> const start{0.5};
    SamplerSettings const few{.chains = 2, .warm_up = 50, .draws = 20, .seed = 9};
    EXPECT_EQ(sample(normal, start, few).values, sample(normal, start, few).values);
    SamplerSettings other = few;
    other.seed = 10;
    EXPECT_NE(sample(normal, start, few).values, sample(normal, start, other).values);
    auto const nowhere = [](std::span<double const>, std::span<double> g) {
        g[0] = 0;
        return -INFINITY;
    };
    EXPECT_THROW(sample(nowhere, start, few), std::invalid_argument);
    EXPECT_THROW(sample(normal, {}, few), std::invalid_argument);
}

/// An autoregressive series of correlation 0.6 in chain `c`, from sines, so that arviz gets the same numbers.
std::vector<std::vector<double>> series(double shift)
{
    std::vector<std::vector<double>> chains(4);
    for (int c = 0; c < 4; ++c) {
        double v = 0;
        for (int i = 0; i < 250; ++i) {
            double const noise = std::sin(12.9898 * (i + 1) + 78.233 * (c + 1)) * 43758.5453;
            v = 0.6 * v + (noise - std::floor(noise)) - 0.5;
            chains[std::size_t(c)].push_back(v + (c == 3 ? shift : 0));
        }
    }
    return chains;
}

TEST(Convergence, IsThatOfArviz)
{
    Convergence const same = convergence(series(0)), apart = convergence(series(0.5));
    EXPECT_NEAR(same.r_hat, 1.0080027, 1e-4);
    EXPECT_NEAR(same.bulk / 224.39471, 1, 1e-3);
    EXPECT_NEAR(same.tail / 466.89893, 1, 1e-3);
    EXPECT_NEAR(apart.r_hat, 1.1837190, 1e-4);
    EXPECT_NEAR(apart.bulk / 15.625202, 1, 1e-3);
    EXPECT_NEAR(apart.tail / 66.280666, 1, 1e-3);
    EXPECT_TRUE(std::isnan(convergence({{1, 2, 3}}).r_hat));
    EXPECT_TRUE(std::isnan(convergence({{1, 1, 1, 1, 1, 1, 1, 1}}).r_hat));
}

TEST(FitByDraws, IsMadeOnceMoreWhereChainsDiffer)
{
    struct Fit {
        SamplerReport report;
        int draws;
    };
    std::vector<double> r_hat;
    auto const fit = [&](SamplerSettings const& s) {
        SamplerReport report;
        report.worst_r_hat = r_hat[0];
        report.least_bulk = report.least_tail = 100 * s.chains;
        r_hat.erase(r_hat.begin());
        return Fit{report, s.draws};
    };
    int const usual = SamplerSettings{}.draws;
    r_hat = {1.01, 1.0};
    EXPECT_EQ(fit_by_draws({}, fit).draws, usual);
    r_hat = {1.011, 1.02, 1.0};
    EXPECT_EQ(fit_by_draws({}, fit).draws, 2 * usual);
    EXPECT_EQ(r_hat.size(), 1u);
    r_hat = {1.02, 1.0};
    EXPECT_EQ(fit_by_draws({.draws = usual / 2}, fit).draws, usual / 2);
}

} // namespace
} // namespace study::test
