#include "gi/core/rqmc.h"

#include <gtest/gtest.h>
#include <set>

namespace gi::test {
namespace {

TEST(Rqmc, EveryDimensionIsStratified)
{
    for (std::uint32_t dimension = 0; dimension < 50; ++dimension) {
        std::set<int> strata;
        RqmcStream s{77, 0};
        for (s.index = 512; s.index < 1024; ++s.index) strata.insert(int(s.sample(dimension) * 512));
        EXPECT_EQ(strata.size(), 512u) << dimension;
    }
}

TEST(Rqmc, PlacesOfOneSeedTakeDifferentStrata)
{
    for (std::uint32_t dimension = 0; dimension < 50; ++dimension) {
        RqmcStream s{79, 0};
        for (s.index = 0; s.index < 40; ++s.index) { // over the places of one index
            std::set<int> strata;
            for (s.place = 0; s.place < 16; ++s.place) strata.insert(int(s.sample(dimension) * 16));
            EXPECT_EQ(strata.size(), 16u) << dimension;
        }
        for (s.place = 0; s.place < 16; ++s.place) { // and over the indices of one place
            std::set<int> strata;
            for (s.index = 64; s.index < 128; ++s.index) strata.insert(int(s.sample(dimension) * 64));
            EXPECT_EQ(strata.size(), 64u) << dimension;
        }
    }
}

TEST(Rqmc, PlacesPairDimensionsInManyWays)
{
    // Over the places of many seeds the strata of two dimensions are independent.
    double product = 0;
    constexpr std::uint32_t kSeeds = 4096;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        RqmcStream s{seed, 0};
        for (s.place = 0; s.place < 16; ++s.place)
            product += (double(s.sample(3)) - 0.5) * (double(s.sample(8)) - 0.5);
    }
    EXPECT_NEAR(12 * product / (16 * kSeeds), 0, 4 / std::sqrt(16.0 * kSeeds)); // correlation
}

TEST(Rqmc, TogetherMeansInTwoDimensionsToo)
{
    RqmcStream s{78, 0};
    std::set<std::pair<int, int>> cells;
    for (s.index = 0; s.index < 256; ++s.index) {
        vec4 const u = s.sample_together(3);
        cells.insert({int(u.x * 16), int(u.y * 16)});
    }
    EXPECT_EQ(cells.size(), 256u);
}

TEST(Rqmc, DimensionsAndStreamsAreNotPaired)
{
    // Correlation of the numbers of two dimensions, of two streams, and of products of halves.
    for (std::uint32_t k = 0; k < 40; ++k) {
        double product = 0, streams = 0;
        constexpr int kPoints = 4096;
        for (std::uint32_t i = 0; i < kPoints; ++i) {
            RqmcStream const a{1000 + k, i}, b{5000 + k, i};
            product += (double(a.sample(k)) - 0.5) * (double(a.sample(k + 1)) - 0.5);
            streams += (double(a.sample(k)) - 0.5) * (double(b.sample(k)) - 0.5);
        }
        EXPECT_LT(std::abs(product / kPoints * 12), 0.08) << k;
        EXPECT_LT(std::abs(streams / kPoints * 12), 0.08) << k;
    }
}

} // namespace
} // namespace gi::test
