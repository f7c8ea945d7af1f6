#include "gi/core/rng.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

TEST(Pcg32, MatchesThePublishedDemo) // pcg32-demo, seeds 42 and 54, round 1
{
    Pcg32 rng(42, 54);
    for (std::uint32_t const expected :
         {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu})
        EXPECT_EQ(rng.next(), expected);
}

TEST(Pcg32, NumbersLieBelowOneAndUseTheirBits)
{
    Pcg32 rng(5, 5);
    bool low_bit_float = false, low_bit_double = false;
    for (int i = 0; i < 100000; ++i) {
        float const f = rng.uniform();
        double const d = rng.uniform_double();
        ASSERT_TRUE(f >= 0 && f < 1 && d >= 0 && d < 1);
        low_bit_float |= std::uint32_t(f * 0x1p24f) % 2 == 1;
        low_bit_double |= std::uint64_t(d * 0x1p53) % 2 == 1;
    }
    EXPECT_TRUE(low_bit_float && low_bit_double);
}

TEST(Pcg32, StreamsOfNeighbouringPathsAreUniformAndIndependent)
{
    std::vector<double> observed(64, 0.0), paths(256, 0.0), pixels(256, 0.0), seeds(256, 0.0);
    auto const cell = [](float a, float b) { return std::size_t(a * 16) * 16 + std::size_t(b * 16); };
    for (std::uint32_t pixel = 0; pixel < 400; pixel += 2)
        for (std::uint32_t path = 0; path < 400; path += 2) {
            float const u = Pcg32::for_path(7, pixel, path).uniform();
            ++observed[std::size_t(u * 64)];
            ++paths[cell(u, Pcg32::for_path(7, pixel, path + 1).uniform())];
            ++pixels[cell(u, Pcg32::for_path(7, pixel + 1, path).uniform())];
            ++seeds[cell(u, Pcg32::for_path(8, pixel, path).uniform())];
        }
    double const level = sidak_level(0.01, 4);
    EXPECT_GT(chi_square_p(observed, std::vector<double>(64, 40000.0 / 64)), level);
    for (auto const* pairs : {&paths, &pixels, &seeds})
        EXPECT_GT(chi_square_p(*pairs, std::vector<double>(256, 40000.0 / 256)), level);
}

TEST(Pcg32, SuccessiveNumbersAreIndependent)
{
    std::vector<double> observed(4096, 0.0);
    Pcg32 rng(11, 3);
    for (int i = 0; i < 400000; ++i) {
        vec2 const u = rng.uniform2();
        auto const x = std::size_t(u.x * 16), y = std::size_t(u.y * 16),
                   z = std::size_t(rng.uniform_double() * 16);
        ++observed[(x * 16 + y) * 16 + z];
    }
    EXPECT_GT(chi_square_p(observed, std::vector<double>(4096, 400000.0 / 4096)), 0.01);
}

} // namespace
} // namespace gi::test
