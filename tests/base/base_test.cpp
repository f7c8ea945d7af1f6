#include "gi/base/alias_table.h"
#include "gi/base/error.h"
#include "gi/base/rng.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

TEST(Frame, IsOrthonormalForAllNormals)
{
    Pcg32 rng(1, 1);
    std::vector<vec3> normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {0, 0, -0.0f}};
    normals.back() = glm::normalize(vec3{1e-4f, -1e-4f, -1});
    for (int i = 0; i < 10000; ++i)
        normals.push_back(glm::normalize(vec3{rng.uniform(), rng.uniform(), rng.uniform()} - 0.5f));
    for (vec3 const n : normals) {
        Frame const f = Frame::about(n);
        EXPECT_NEAR(glm::length(f.tangent), 1, 1e-5);
        EXPECT_NEAR(glm::length(f.bitangent), 1, 1e-5);
        EXPECT_NEAR(glm::dot(f.tangent, f.bitangent), 0, 1e-5);
        EXPECT_NEAR(glm::dot(f.tangent, n), 0, 1e-5);
        EXPECT_NEAR(glm::distance(glm::cross(f.tangent, f.bitangent), n), 0, 1e-5);
        vec3 const v{0.3f, -0.4f, 0.8f};
        EXPECT_NEAR(glm::distance(f.to_world(f.to_local(v)), v), 0, 1e-5);
    }
}

TEST(Pcg32, MatchesThePublishedDemo) // pcg32-demo, seeds 42 and 54, round 1
{
    Pcg32 rng(42, 54);
    for (std::uint32_t const expected :
         {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu})
        EXPECT_EQ(rng.next(), expected);
}

TEST(Pcg32, StreamsOfNeighbouringPathsAreUniformAndIndependent)
{
    std::vector<double> observed(64, 0.0), pairs(256, 0.0);
    for (std::uint32_t pixel = 0; pixel < 400; ++pixel)
        for (std::uint32_t path = 0; path < 100; ++path) {
            float const a = Pcg32::for_path(7, pixel, path).uniform(), b = Pcg32::for_path(7, pixel, path + 1).uniform();
            ++observed[std::size_t(a * 64)];
            if (path % 2 == 0) ++pairs[std::size_t(a * 16) * 16 + std::size_t(b * 16)];
        }
    EXPECT_GT(chi_square_p(observed, std::vector<double>(64, 40000.0 / 64)), 0.001);
    EXPECT_GT(chi_square_p(pairs, std::vector<double>(256, 20000.0 / 256)), 0.001);
}

TEST(AliasTable, DrawsInProportion)
{
    std::vector<float> const weights{0, 1, 5, 0.25f, std::nanf(""), 3, -2, 10};
    AliasTable const table = make_alias_table(weights);
    std::vector<double> observed(weights.size(), 0.0), expected(weights.size(), 0.0), remapped(32, 0.0);
    Pcg32 rng(3, 3);
    constexpr int kDraws = 200000;
    for (int i = 0; i < kDraws; ++i) {
        double u = rng.uniform_double();
        ++observed[view(table).sample(u)];
        ASSERT_GE(u, 0);
        ASSERT_LT(u, 1);
        ++remapped[std::size_t(u * 32)];
    }
    for (std::size_t i = 0; i < weights.size(); ++i) expected[i] = kDraws * double(table.entries[i].probability);
    EXPECT_EQ(expected[0] + expected[4] + expected[6], 0);
    EXPECT_NEAR(table.entries[7].probability, 10 / 19.25, 1e-6);
    EXPECT_GT(chi_square_p(observed, expected), 0.001);
    EXPECT_GT(chi_square_p(remapped, std::vector<double>(32, kDraws / 32.0)), 0.001);
    EXPECT_TRUE(make_alias_table(std::vector<float>{0, 0}).empty());
}

TEST(InputError, ReadsProblemWhySuggestion)
{
    EXPECT_STREQ(InputError("it is wrong", "because", "do this").what(), "it is wrong (because) do this");
    EXPECT_STREQ(InputError({"a.yaml", 3, 7}, "it is wrong", "because", "do this").what(),
                 "a.yaml:3:7: it is wrong (because) do this");
}

} // namespace
} // namespace gi::test
