// Samplers of scattering against their densities.

#include "gi/core/rng.h"
#include "tests/support/bsdf_cases.h"
#include "tests/support/sphere_chi2.h"
#include "tests/support/statistics.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

constexpr int kSamples = 150000;

struct SamplerView {
    std::string name;
    Bsdf bsdf;
    vec3 wo;
    SphereBins bins;
};

std::vector<SamplerView> sampler_views()
{
    std::vector<SamplerView> all;
    for (BsdfCase const& c : scattering_materials())
        for (double const angle : view_angles()) {
            SamplerView s{
                fmt::format("{} from {} degrees", c.name, angle), make_bsdf(c.material), seen_at(angle), {}};
            all.push_back(s);
            if (c.name != "metal 0.1" && c.name != "phong 1000") continue;
            // Narrow lobes fit into few bins: look at them closely too.
            s.name += ", around the mirror direction";
            s.bins.frame = Frame::about({-s.wo.x, -s.wo.y, s.wo.z});
            s.bins.focus = 4;
            all.push_back(s);
        }
    return all;
}

TEST(BsdfChi2, SamplesFollowTheirDensity)
{
    std::vector<SamplerView> const all = sampler_views();
    double const level = sidak_level(0.01, all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        SamplerView const& s = all[i];
        Pcg32 rng(2026, i);
        auto const draw = [&]() -> std::optional<vec3> {
            float const u_lobe = rng.uniform();
            BsdfSample const drawn = sample(s.bsdf, s.wo, true, u_lobe, rng.uniform2());
            if (drawn.delta || !(drawn.pdf > 0)) return std::nullopt;
            return drawn.wi;
        };
        SphereChi2 const result = test_sampler(
            s.bins, draw, [&](vec3 wi) { return double(evaluate(s.bsdf, s.wo, wi).pdf); }, kSamples);
        EXPECT_GT(result.p, level) << s.name << ": integral of the pdf " << result.integral
                                   << ", rejected or delta " << result.rejected;
        double const sigma = std::sqrt(result.rejected * (1 - result.rejected) / kSamples);
        EXPECT_NEAR(result.integral, 1 - result.rejected, 4.5 * sigma + 1e-4) << s.name;
    }
}

TEST(BsdfChi2, WeightIsValueOverDensity)
{
    Pcg32 rng(2027, 0);
    for (SamplerView const& s : sampler_views())
        for (int i = 0; i < 2000; ++i) {
            float const u_lobe = rng.uniform();
            BsdfSample const drawn = sample(s.bsdf, s.wo, true, u_lobe, rng.uniform2());
            if (drawn.delta) continue;
            if (!(drawn.pdf > 0)) {
                ASSERT_EQ(drawn.weight, vec3{0}) << s.name;
                continue;
            }
            ASSERT_NEAR(glm::length(drawn.wi), 1, 1e-5) << s.name;
            ASSERT_FALSE(drawn.transmitted) << s.name;
            ASSERT_NEAR(drawn.pdf, evaluate(s.bsdf, s.wo, drawn.wi).pdf, 1e-4 * double(drawn.pdf)) << s.name;
            vec3 const value = evaluate(s.bsdf, s.wo, drawn.wi).f * drawn.wi.z, again = drawn.weight * drawn.pdf;
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(again[c], value[c], 1e-4 * double(value[c]) + 1e-12) << s.name;
        }
}

TEST(BsdfChi2, NothingScattersBelowTheSurface)
{
    Pcg32 rng(2028, 0);
    for (BsdfCase const& c : scattering_materials()) {
        Bsdf const b = make_bsdf(c.material);
        for (double const angle : {90.5, 120.0, 180.0}) {
            vec3 const below = seen_at(angle), above = seen_at(40);
            EXPECT_EQ(sample(b, below, true, rng.uniform(), rng.uniform2()).weight, vec3{0}) << c.name;
            EXPECT_EQ(evaluate(b, below, above).f, vec3{0}) << c.name;
            EXPECT_EQ(evaluate(b, above, below).f, vec3{0}) << c.name;
            EXPECT_EQ(evaluate(b, below, above).pdf, 0) << c.name;
            EXPECT_EQ(evaluate(b, above, below).pdf, 0) << c.name;
        }
    }
}

TEST(BsdfChi2, OnlyDeltaSaysWhetherLightsAreWorthSampling)
{
    for (BsdfCase const& c : scattering_materials()) EXPECT_FALSE(only_delta(make_bsdf(c.material))) << c.name;
    for (BsdfCase const& c : delta_materials()) {
        Bsdf const b = make_bsdf(c.material);
        EXPECT_TRUE(only_delta(b)) << c.name;
        EXPECT_EQ(evaluate(b, seen_at(30), seen_at(30, 215)).f, vec3{0}) << c.name;
        EXPECT_EQ(evaluate(b, seen_at(30), seen_at(30, 215)).pdf, 0) << c.name;
    }
}

} // namespace
} // namespace gi::test
