#include "gi/metrics/neighbour_correlation.h"

#include "gi/core/rng.h"

#include <cmath>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

constexpr int kSide = 64;

/// One value for every block of n x n pixels.
std::vector<float> blocks(int n, std::uint64_t seed)
{
    Pcg32 rng(seed, 1);
    int const across = (kSide + n - 1) / n;
    std::vector<float> of_block(std::size_t(across * across));
    for (float& v : of_block) v = rng.uniform();
    std::vector<float> picture;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            for (int c = 0; c < 3; ++c) picture.push_back(of_block[std::size_t(y / n * across + x / n)]);
    return picture;
}

TEST(NeighbourCorrelation, OfIndependentAndOfSharedErrors)
{
    std::vector<float> const flat(3 * kSide * kSide, 0.5f);
    EXPECT_NEAR(neighbour_correlation(blocks(1, 1), flat, kSide, kSide), 0, 0.05);
    // Of pairs across, 7 of 8 lie within a block of 8, and those of two blocks are independent.
    EXPECT_NEAR(neighbour_correlation(blocks(8, 2), flat, kSide, kSide), 0.888, 0.03);
    EXPECT_GT(neighbour_correlation(blocks(32, 3), flat, kSide, kSide), 0.9);
}

TEST(NeighbourCorrelation, IsUndefinedWithoutErrorsThatVary)
{
    std::vector<float> const flat(3 * kSide * kSide, 0.5f), brighter(3 * kSide * kSide, 0.6f);
    EXPECT_TRUE(std::isnan(neighbour_correlation(flat, flat, kSide, kSide)));
    EXPECT_TRUE(std::isnan(neighbour_correlation(brighter, flat, kSide, kSide)));
    std::vector<float> broken = blocks(1, 4);
    broken[0] = std::nanf("");
    EXPECT_TRUE(std::isfinite(neighbour_correlation(broken, flat, kSide, kSide)));
}

} // namespace
} // namespace gi::test
