#include "gi/core/alias_table.h"
#include "gi/core/rng.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>
#include <limits>
#include <numeric>

namespace gi::test {
namespace {

struct Draws {
    std::vector<double> observed, remapped;
};

Draws draw(AliasTable const& table, int count, std::uint64_t seed)
{
    Draws d{std::vector<double>(table.entries.size(), 0.0), std::vector<double>(32, 0.0)};
    Pcg32 rng(seed, 3);
    for (int i = 0; i < count; ++i) {
        double u = rng.uniform_double();
        ++d.observed[view(table).sample(u)];
        EXPECT_TRUE(u >= 0 && u < 1) << u;
        ++d.remapped[std::size_t(u * 32)];
    }
    return d;
}

TEST(AliasTable, DrawsInProportion)
{
    constexpr int kDraws = 200000;
    std::vector<std::vector<float>> all{{1, 1, 1, 1}, {1, 5, 0.25f, 3, 10}, {1e-20f, 1, 1e20f, 3e20f}, {}};
    Pcg32 rng(21, 0);
    for (int i = 0; i < 1000; ++i) all.back().push_back(std::pow(rng.uniform(), 4.0f));
    double const level = sidak_level(0.01, 2 * all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        AliasTable const table = make_alias_table(all[i]);
        double const total = std::accumulate(all[i].begin(), all[i].end(), 0.0);
        EXPECT_NEAR(table.total / total, 1, 1e-12);
        std::vector<double> expected;
        for (std::size_t k = 0; k < all[i].size(); ++k) {
            double const p = double(all[i][k]) / total;
            EXPECT_NEAR(table.entries[k].probability, p, 1e-7 * p + 1e-44);
            expected.push_back(kDraws * p);
        }
        Draws const d = draw(table, kDraws, i);
        EXPECT_GT(chi_square_p(d.observed, expected), level) << "table " << i;
        EXPECT_GT(chi_square_p(d.remapped, std::vector<double>(32, kDraws / 32.0)), level)
            << "what is left of u, " << i;
    }
}

/// The table itself, without chance: every bin's share of all entries is its probability.
TEST(AliasTable, SharesAddUpToProbabilities)
{
    Pcg32 rng(22, 0);
    for (std::size_t const n : {1u, 2u, 3u, 1000u, 100000u}) {
        std::vector<float> weights;
        for (std::size_t i = 0; i < n; ++i) weights.push_back(i % 7 == 3 ? 0.0f : std::pow(rng.uniform(), 8.0f));
        AliasTable const table = make_alias_table(weights);
        std::vector<double> share(n, 0.0);
        for (std::size_t i = 0; i < n; ++i) {
            share[i] += double(table.entries[i].keep) / double(n);
            share[table.entries[i].alias] += (1 - double(table.entries[i].keep)) / double(n);
        }
        for (std::size_t i = 0; i < n; ++i)
            ASSERT_NEAR(share[i], table.entries[i].probability, 1e-6 * share[i] + 1e-7 / double(n))
                << n << " " << i;
    }
}

TEST(AliasTable, WhatHasNoWeightIsNeverDrawn)
{
    float const nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    std::vector<float> const weights{0, 1, nan, 5, -2, inf, -inf, 3, 0};
    AliasTable const table = make_alias_table(weights);
    EXPECT_EQ(table.total, 9);
    Draws const d = draw(table, 100000, 23);
    for (std::size_t const i : {0u, 2u, 4u, 5u, 6u, 8u}) {
        EXPECT_EQ(d.observed[i], 0) << i;
        EXPECT_EQ(table.entries[i].probability, 0) << i;
    }
    EXPECT_GT(chi_square_p(d.observed, {0, 1e5 / 9, 0, 5e5 / 9, 0, 0, 0, 3e5 / 9, 0}), 0.01);
}

TEST(AliasTable, OneWeightIsAlwaysDrawn)
{
    AliasTable const table = make_alias_table(std::vector<float>{3});
    for (double const at : {0.0, 0.5, 1 - 0x1p-53}) {
        double u = at;
        EXPECT_EQ(view(table).sample(u), 0u);
        EXPECT_NEAR(u, at, 1e-15);
    }
}

TEST(AliasTable, NoWeightAtAllGivesNoTable)
{
    EXPECT_TRUE(make_alias_table(std::vector<float>{}).empty());
    EXPECT_TRUE(make_alias_table(std::vector<float>{0, 0}).empty());
    EXPECT_TRUE(make_alias_table(std::vector<float>{-1, std::nanf("")}).empty());
    EXPECT_TRUE(view(AliasTable{}).empty());
}

} // namespace
} // namespace gi::test
