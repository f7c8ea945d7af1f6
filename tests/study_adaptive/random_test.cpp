// The numbers that make orders of trials: those that were published, and no order preferred.

#include "study/numeric/random.h"

#include <array>
#include <gtest/gtest.h>

namespace study::test {
namespace {

TEST(Random, GivesThePublishedNumbersOfPcg32)
{
    Random random(42, 54); // the demonstration of the PCG library prints these
    for (std::uint32_t const expected :
         {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu})
        EXPECT_EQ(random.next(), expected);
}

TEST(Random, BelowIsUnbiasedWhereTheModulusWouldNotBe)
{
    Random random(1);
    // Plain remainders would give values below 2^30 half of the time instead of a third.
    std::uint32_t const n = 3u << 30;
    int low = 0;
    int const draws = 30000;
    for (int i = 0; i < draws; ++i) low += random.below(n) < (1u << 30);
    EXPECT_NEAR(low, draws / 3.0, 5 * std::sqrt(draws * 2.0 / 9));
    EXPECT_EQ(random.below(1), 0u);
    EXPECT_THROW(random.below(0), std::invalid_argument);
}

TEST(Random, ShufflesIntoEveryOrderEquallyOften)
{
    Random random(7, 3);
    std::array<int, 24> counts{};
    int const rounds = 24000;
    for (int round = 0; round < rounds; ++round) {
        std::vector<int> items{0, 1, 2, 3};
        random.shuffle(items);
        int index = 0;
        for (int i = 0; i < 4; ++i) {
            int smaller = 0;
            for (int j = i + 1; j < 4; ++j) smaller += items[j] < items[i];
            index = index * (4 - i) + smaller;
        }
        ++counts[index];
    }
    double chi2 = 0;
    for (int const c : counts) chi2 += (c - 1000.0) * (c - 1000.0) / 1000;
    EXPECT_LT(chi2, 49.7); // 99.9 % point of 23 degrees of freedom
    std::vector<int> none;
    random.shuffle(none);
    EXPECT_TRUE(none.empty());
}

TEST(Random, NormalHasMeanNoughtAndVarianceOne)
{
    Random random(5);
    double sum = 0, squares = 0, fourth = 0;
    int const n = 100000;
    for (int i = 0; i < n; ++i) {
        double const x = random.normal();
        sum += x;
        squares += x * x;
        fourth += x * x * x * x;
    }
    EXPECT_NEAR(sum / n, 0, 5 / std::sqrt(n));
    EXPECT_NEAR(squares / n, 1, 5 * std::sqrt(2.0 / n));
    EXPECT_NEAR(fourth / n, 3, 5 * std::sqrt(96.0 / n));
}

TEST(Random, StreamsOfOneSeedDiffer)
{
    Random a(9, 1), b(9, 2), again(9, 1);
    std::uint32_t const first = a.next();
    EXPECT_NE(first, b.next());
    EXPECT_EQ(first, again.next());
}

TEST(Random, PartsOfASeedAreSpreadByChance)
{
    // 4,000 first numbers in 100 bins: chance fills them unevenly, a lattice does not.
    auto const chi2 = [](auto const& first) {
        std::array<int, 100> bins{};
        for (std::uint64_t i = 0; i < 4000; ++i) ++bins[std::size_t(first(i) * 100)];
        double sum = 0;
        for (int const b : bins) sum += (b - 40.0) * (b - 40.0) / 40;
        return sum;
    };
    double const parts = chi2([](std::uint64_t i) { return Random::part(7, i).uniform(); });
    EXPECT_GT(parts, 57); // 0.02 % and 99.98 % points of 99 degrees of freedom
    EXPECT_LT(parts, 155);
    EXPECT_NE(Random::part(7, 0).next(), Random::part(8, 0).next());
}

} // namespace
} // namespace study::test
