#include "gi/core/rng.h"
#include "viewer/bench/lag.h"

#include <cmath>
#include <gtest/gtest.h>

namespace viewer {
namespace {

gi::Picture picture_of(std::vector<float> values)
{
    gi::Picture p;
    p.width = int(values.size()) / 3;
    p.height = 1;
    p.layers.push_back({"color", 3, std::move(values)});
    return p;
}

TEST(LagError, IsWhatReuseAddsApartFromNoise)
{
    constexpr std::size_t kValues = 3000;
    constexpr float kTruth = 0.3f, kLag = 0.05f;
    gi::Pcg32 rng(7, 1);
    auto const noisy = [&](float mean) {
        std::vector<float> v(kValues);
        for (float& x : v) x = mean + (rng.uniform() - 0.5f);
        return picture_of(v);
    };
    gi::Picture const truth = picture_of(std::vector<float>(kValues, kTruth));
    LagError lagging(2);
    for (std::size_t seed = 0; seed < 16; ++seed) {
        lagging.add(seed, 0, noisy(kTruth + kLag), noisy(kTruth));
        lagging.add(seed, 1, noisy(kTruth), noisy(kTruth));
    }
    // Noise of one difference has a variance of 1/6, of the mean of its product 1/6/8/sqrt(3000).
    double const scale = 1 / (0.3 * 0.3 + 0.01), sigma = scale / 6 / 8 / std::sqrt(double(kValues));
    EXPECT_NEAR(lagging.relmse(0, truth), kLag * kLag * scale, 6 * sigma);
    EXPECT_NEAR(lagging.relmse(1, truth), 0, 4 * sigma);
}

TEST(LagError, OneSeedSaysNothing)
{
    LagError lag(1);
    gi::Picture const p = picture_of({1, 2, 3});
    lag.add(0, 0, p, p);
    EXPECT_TRUE(std::isnan(lag.relmse(0, p)));
}

} // namespace
} // namespace viewer
