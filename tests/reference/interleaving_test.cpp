// Interleaved indirect light: the order of pixels, the light given to waiting pixels, and the time of frames.

#include "gi/render/interleaving.h"

#include "gi/methods/reference/reference.h"
#include "gi/scene/motion/moving_world.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

TEST(Interleaving, EveryPixelHasItsTurnOnce)
{
    constexpr std::uint32_t kWidth = 13, kPixels = kWidth * 7;
    for (std::uint32_t n = 1; n <= 16; ++n) {
        Interleaving const of{n};
        for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
            std::uint32_t sum = 0;
            for (std::uint32_t pass = 100; pass < 100 + n * n; ++pass) {
                std::uint32_t const share = of.share(pixel, kWidth, pass);
                sum += share;
                std::uint32_t const turn = of.turn(pass);
                EXPECT_EQ(share > 0, pixel % kWidth % n == turn % n && pixel / kWidth % n == turn / n);
            }
            EXPECT_EQ(sum, n * n) << n;
        }
    }
}

/// A floor seen from above; what is taken is n^2-fold.
std::vector<PathSample> floor_samples(int width, int height, Interleaving const& of, std::uint32_t pass)
{
    std::vector<PathSample> samples(std::size_t(width) * std::size_t(height));
    for (std::uint32_t p = 0; p < samples.size(); ++p) {
        PathSample& s = samples[p];
        s.hit = true;
        s.depth = 2;
        s.normal = {0, 1, 0};
        s.position = {0.01f * float(p % std::uint32_t(width)), 0, 0.01f * float(p / std::uint32_t(width))};
        s.albedo = vec3{p % 2 == 0 ? 0.8f : 0.2f};
        std::uint32_t const share = of.share(p, std::uint32_t(width), pass);
        s.turn = share > 0 ? IndirectTurn::taken : IndirectTurn::waits;
        s.radiance[2] = float(share) * 3.0f * s.albedo;
    }
    return samples;
}

TEST(Interleaving, HandsOnLightOverTheAlbedo)
{
    for (int n = 2; n <= 4; ++n)
        for (std::uint32_t pass = 0; pass < 5; ++pass) {
            Interleaving const of{std::uint32_t(n)};
            std::vector<PathSample> samples = floor_samples(31, 17, of, pass);
            spread_indirect(samples, 31, of, pass);
            for (PathSample const& s : samples)
                EXPECT_NEAR(s.radiance[2].x, 3 * s.albedo.x, 1e-5) << n << ", " << pass;
        }
}

TEST(Interleaving, TakesLightFromTheSameSurface)
{
    Interleaving const of{4};
    std::vector<PathSample> samples = floor_samples(16, 16, of, 0);
    for (std::size_t p = 0; p < samples.size(); ++p)
        if (p % 16 >= 6) { // a bright wall behind the floor
            samples[p].normal = {0, 0, 1};
            samples[p].position.z = -5;
            samples[p].depth = 7;
            samples[p].radiance[2] *= 100.0f;
        }
    spread_indirect(samples, 16, of, 0);
    for (std::size_t p = 0; p < samples.size(); p += 16)
        for (std::size_t x = 0; x < 6; ++x)
            EXPECT_LT(samples[p + x].radiance[2].x, 3.4f * samples[p + x].albedo.x) << p + x;
}

TEST(Interleaving, DarkAndSpecularNeighboursDoNoHarm)
{
    Interleaving const of{2};
    std::vector<PathSample> samples = floor_samples(8, 8, of, 0);
    samples[0].albedo = samples[0].radiance[2] = vec3{0};
    samples[1].turn = IndirectTurn::each; // a mirror: it has its own
    samples[1].radiance[2] = vec3{5};
    samples[63] = {}; // the sky
    spread_indirect(samples, 8, of, 0);
    EXPECT_EQ(samples[1].radiance[2], vec3{5});
    EXPECT_EQ(samples[63].radiance[2], vec3{0});
    for (PathSample const& s : samples) EXPECT_TRUE(std::isfinite(s.radiance[2].x) && s.radiance[2].x <= 5);
}

TEST(Interleaving, HoldsTheTimeOfFrames)
{
    // 60 ms besides, 100 ms of indirect light in all pixels, costs of a path that rise as they are fewer.
    auto const frame_s = [](int n) { return std::pair{0.06, 0.1 / std::pow(double(n), 1.6)}; };
    for (auto const& [budget_s, expected] : {std::pair{0.2, 1}, {0.13, 2}, {0.085, 3}, {0.072, 4}, {0.01, 4}}) {
        int n = 1;
        for (int frame = 0; frame < 10; ++frame) {
            auto const [rest, indirect] = frame_s(n);
            n = next_interleaving(n, budget_s, rest + indirect, indirect);
        }
        EXPECT_EQ(n, expected) << budget_s;
        for (int frame = 0; frame < 10; ++frame) {
            auto const [rest, indirect] = frame_s(n);
            EXPECT_EQ(next_interleaving(n, budget_s, rest + indirect, indirect), n) << "nor does it swing";
        }
    }
    EXPECT_EQ(next_interleaving(4, 1, 0.05, 0.01), 3) << "a step at a time";
}

} // namespace
} // namespace gi::test
