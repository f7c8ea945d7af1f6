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
            EXPECT_LE(s, std::max(1 / rate, seconds_of(least, pixels) * 1.01)) << rate << " Hz, " << pixels;
            if (seconds_of({2, 1}, pixels) < 0.5 / rate && seconds_of({200, 1}, pixels) > 1 / rate) {
                EXPECT_GT(s, 0.4 / rate) << rate << " Hz, " << pixels;
            }
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

} // namespace
} // namespace viewer::test
