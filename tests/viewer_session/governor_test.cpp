#include "viewer/engine/governor.h"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace viewer::test {
namespace {

/// A machine that needs 50 ns for a path and 40 ns for the rest of a pixel.
double seconds_of(FrameBudget const& b, double pixels)
{
    return 1e-9 * pixels * b.scale * b.scale * (50 * b.paths + 40);
}

double settle(Governor& g, double rate_hz, double pixels, bool still)
{
    double seconds = 0;
    for (int i = 0; i < 60; ++i) {
        FrameBudget const b = g.next(pixels, still);
        g.measured(b, pixels, seconds = seconds_of(b, pixels), rate_hz);
    }
    return seconds;
}

TEST(Governor, HoldsTheRate)
{
    for (double const rate : {5.0, 10.0, 30.0, 60.0, 90.0})
        for (double const pixels : {64e3, 300e3, 2e6}) {
            Governor g;
            double const s = settle(g, rate, pixels, false);
            FrameBudget const least{1, 0.25};
            // Half the rate rather than light at a quarter of the size.
            double const longest_s = g.next(pixels, false).scale < 0.5 ? 1 / (0.5 * rate) : 1 / rate;
            EXPECT_LE(s, std::max(longest_s, seconds_of(least, pixels) * 1.01)) << rate << " Hz, " << pixels;
            if (seconds_of({2, 1}, pixels) < 0.5 / rate && seconds_of({200, 1}, pixels) > 1 / rate) {
                EXPECT_GT(s, 0.4 / rate) << rate << " Hz, " << pixels;
            }
        }
}

/// The largest light with which half of the rate holds, before light at a quarter of the size.
TEST(Governor, LightIsNotTooCoarseWhereTheRateMayFall)
{
    double const rate = 20;
    double const fits = 0.05 / seconds_of({1, 1}, 1); // pixels of one path in the time of a frame
    for (auto const& [pixels, scale] : std::vector<std::pair<double, double>>{{0.7 * fits, 1},
                                                                              {2.5 * fits, 0.5},
                                                                              {5 * fits, 0.4375},
                                                                              {10 * fits, 0.35},
                                                                              {15 * fits, 0.3125},
                                                                              {25 * fits, 0.25}}) {
        Governor g;
        settle(g, rate, pixels, false);
        EXPECT_EQ(g.next(pixels, false).scale, scale) << pixels / fits;
    }
}

TEST(Governor, ASlowFrameIsFollowedByASmallerOne)
{
    Governor g;
    settle(g, 30, 300e3, false);
    FrameBudget const before = g.next(300e3, false);
    g.measured(before, 300e3, 5 * seconds_of(before, 300e3), 30);
    FrameBudget const after = g.next(300e3, false);
    EXPECT_LT(after.scale * after.scale * after.paths, 0.5 * before.scale * before.scale * before.paths);
}

TEST(Governor, AStillPictureHasItsFullSize)
{
    Governor g;
    settle(g, 60, 4e6, false);
    EXPECT_LT(g.next(4e6, false).scale, 1);
    EXPECT_EQ(g.next(4e6, true).scale, 1);
}

TEST(Governor, WhatIsHeldFixedStays)
{
    Governor g;
    settle(g, 60, 1e6, false);
    FrameBudget const b = g.next(1e6, false, {7, 0.6});
    EXPECT_EQ(b.paths, 7);
    EXPECT_EQ(b.scale, 0.6);
    g.measured({1, 1}, 1e6, std::nan(""), 60);
    EXPECT_GE(g.next(1e6, false).paths, 1);
}

/// A machine whose surfaces need a fixed time and one per pixel, beside light that needs a multiple of the above.
struct SurfaceMachine {
    double fixed_s, pixel_s;
    double pixels = 300e3, rate_hz = 20;
    double surfaces_s(FrameBudget const& b) const { return fixed_s + pixel_s * pixels * b.surfaces * b.surfaces; }
    std::vector<double> run(Governor& g, int frames) const
    {
        std::vector<double> scales;
        for (int i = 0; i < frames; ++i) {
            FrameBudget const b = g.next(pixels, false, {0, 0, 0}, true);
            EXPECT_GE(b.surfaces, b.scale);
            // Surfaces of the size of light cost nothing besides.
            double const own_s = b.surfaces > b.scale ? surfaces_s(b) : 0;
            g.measured(b, pixels, 8 * seconds_of(b, pixels) + own_s, rate_hz, own_s);
            scales.push_back(b.surfaces);
        }
        return scales;
    }
};

TEST(Governor, SurfacesHaveTheirFullSizeWhereThereIsTime)
{
    Governor g;
    std::vector<double> const scales = SurfaceMachine{0.001, 30e-9}.run(g, 100);
    for (std::size_t i = 0; i < scales.size(); ++i) EXPECT_EQ(scales[i], i < 4 ? 0.5 : 1) << i;
    EXPECT_EQ(g.next(300e3, false).surfaces, g.next(300e3, false).scale) << "none of their own";
    FrameBudget const fixed = g.next(300e3, false, {0, 0.4, 0.4}, true);
    EXPECT_EQ(fixed.surfaces, 0.4);
    FrameBudget const still = g.next(300e3, true, {0, 0, 0}, true);
    EXPECT_EQ(still.scale, 1);
    EXPECT_EQ(still.surfaces, 1);
}

TEST(Governor, SurfacesShrinkWhereTheyTakeTooLongAndGrowAgain)
{
    Governor g;
    SurfaceMachine const slow{0.002, 150e-9}, fast{0.001, 30e-9}; // 47 ms and 10 ms of 50 ms at full size
    std::vector<double> const shrunk = slow.run(g, 60);
    EXPECT_LT(shrunk.back(), 1);
    EXPECT_LT(slow.surfaces_s({1, 0.25, shrunk.back()}), 0.75 / slow.rate_hz);
    std::vector<double> const grown = fast.run(g, 200);
    EXPECT_EQ(grown.back(), 1);
    EXPECT_GE(grown[0], 0.5);
}

/// Changes of size are seen: on a machine on which a size nearly fits, they are rare, and become rarer.
TEST(Governor, SurfacesDoNotFlap)
{
    for (double const pixel_s : {60e-9, 75e-9, 82e-9, 90e-9, 110e-9, 140e-9, 200e-9}) {
        Governor g;
        std::vector<double> const scales = SurfaceMachine{0.001, pixel_s}.run(g, 2000);
        auto const changes = [&](std::size_t first, std::size_t last) {
            int n = 0;
            for (std::size_t i = first + 1; i < last; ++i) n += scales[i] != scales[i - 1];
            return n;
        };
        EXPECT_LE(changes(0, 1000), 16) << pixel_s;
        EXPECT_LE(changes(1000, 2000), 5) << pixel_s;
    }
}

/// Frames that now and then take five times as long do not keep surfaces small.
TEST(Governor, SingleSlowFramesChangeLittle)
{
    Governor g;
    SurfaceMachine const machine{0.001, 30e-9}, hiccup{0.005, 150e-9};
    int full = 0;
    for (int i = 0; i < 20; ++i) {
        hiccup.run(g, 1);
        for (double const s : machine.run(g, 40)) full += s == 1;
    }
    EXPECT_GT(full, 700);
}

} // namespace
} // namespace viewer::test
