// The number of axes updated for moving geometry, with frame times of a simulated machine.

#include "viewer/engine/update_governor.h"

#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace viewer::test {
namespace {

constexpr double kRate = 20; // Hz

/// DynamicUpdate one axis takes so long, s; bounces choose theirs by themselves.
struct Machine {
    UpdateGovernor governor;
    double axis_s;
    bool moves = true;
    int bounces = 3, stored = 160;

    int axes(int n) const
    {
        if (n == 0) return stored;
        double const part = 1.0 / std::max(1, stored / n);
        return int(std::lround(stored * (1 - std::pow(1 - part, bounces))));
    }
    int frame(double slower = 1)
    {
        int const n = governor.next(moves);
        governor.measured({{stored, axes(n), bounces, moves ? slower * axis_s * axes(n) : 0}, moves, kRate});
        return n;
    }
    double share(int n) const { return axis_s * axes(n) * kRate; }
    int settle()
    {
        int n = 0;
        for (int i = 0; i < 100; ++i) n = frame();
        return n;
    }
};

TEST(UpdateGovernor, AllFollowWhatCostsLittle)
{
    Machine m{{}, 0.1 * 0.05 / 160};
    for (int i = 0; i < 50; ++i) EXPECT_EQ(m.frame(), 0);
    EXPECT_NEAR(m.governor.share_of_all(), 0.1, 1e-9);
}

TEST(UpdateGovernor, FewerFollowWhatCostsMuch)
{
    int last = 1000;
    for (double const share : {0.15, 0.3, 0.6, 1.2, 5.0}) {
        Machine m{{}, share * 0.05 / 160};
        int const n = m.settle();
        EXPECT_LE(n == 0 ? 160 : n, last) << share;
        last = n == 0 ? 160 : n;
        if (share < 1) { // the least number that there is holds more no more
            EXPECT_LE(m.share(n), n == 16 ? 0.35 : 0.2) << share;
        }
    }
    EXPECT_EQ(last, 8);
}

TEST(UpdateGovernor, FallsAtOnceWhereAFrameIsMissed)
{
    Machine m{{}, 0.1 * 0.05 / 160};
    m.settle();
    m.axis_s *= 12; // a crowd comes
    EXPECT_EQ(m.frame(), 0);
    EXPECT_GT(m.frame(), 0);
    EXPECT_LE(m.share(m.frame()), 0.35);
    m.axis_s /= 12; // and leaves
    for (int i = 0; i < 40; ++i) m.frame();
    EXPECT_EQ(m.frame(), 0);
}

TEST(UpdateGovernor, OneSlowFrameChangesNothing)
{
    Machine m{{}, 0.18 * 0.05 / 160};
    m.settle();
    EXPECT_EQ(m.frame(2.5), 0);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(m.frame(), 0);
}

/// Times that scatter by a quarter up and down, about every threshold.
TEST(UpdateGovernor, DoesNotFlap)
{
    for (int const stored : {160, 40})
        for (int const bounces : {1, 2, 3})
            for (double share = 0.02; share < 3; share *= 1.1) {
                Machine m{{}, share * 0.05 / stored, true, bounces, stored};
                m.settle();
                std::uint32_t random = 12345;
                int changes = 0, last = m.governor.next(true);
                for (int i = 0; i < 500; ++i) {
                    random = random * 1664525u + 1013904223u;
                    int const n = m.frame(0.75 + 0.5 * double(random >> 8) / double(1 << 24));
                    changes += n != last;
                    last = n;
                }
                EXPECT_LE(changes, 2) << share << " of " << stored << ", " << bounces << " bounces";
                EXPECT_NEAR(m.governor.share_of_all(), share, 0.35 * share);
            }
}

TEST(UpdateGovernor, AllFollowWhereNothingMovesAndAsManyAsBeforeAfterwards)
{
    Machine m{{}, 0.8 * 0.05 / 160};
    int const before = m.settle();
    ASSERT_GT(before, 0);
    m.moves = false;
    int last = before, steps = 0;
    while (m.frame() != 0) ASSERT_LT(++steps, 5);
    for (int i = 0; i < 100; ++i) last = m.frame();
    EXPECT_EQ(last, 0);
    m.moves = true;
    EXPECT_EQ(m.frame(), before);
}

/// A head that is tracked, or a lamp that is dimmed: something might have moved, and did not.
TEST(UpdateGovernor, WhatOnlyMayMoveIsNotFollowedForLong)
{
    UpdateGovernor g;
    for (int i = 0; i < 20; ++i) {
        g.next(true);
        g.measured({{160, 160, 3, 0.04}, true, kRate});
    }
    EXPECT_GT(g.next(true), 0);
    for (int i = 0; i < 20; ++i) {
        g.next(true);
        g.measured({{160, 160, 3, 0}, false, kRate});
    }
    EXPECT_EQ(g.next(true), 0);
}

TEST(UpdateGovernor, SaysWhatItDoesAndWhy)
{
    EXPECT_EQ(schedule_sentence("streamed", 8, 160, 1), "streamed, as it was set");
    EXPECT_EQ(schedule_sentence("auto", 0, 0, 0), "");
    EXPECT_NE(schedule_sentence("auto", 0, 160, 0).find("nothing has moved"), std::string::npos);
    EXPECT_NE(schedule_sentence("auto", 0, 160, 0.1).find("all 160 directions"), std::string::npos);
    std::string const some = schedule_sentence("auto", 16, 160, 0.6);
    EXPECT_NE(some.find("16 of 160"), std::string::npos);
    EXPECT_NE(some.find("60 %"), std::string::npos);
    EXPECT_NE(schedule_sentence("auto", 32, 40, 0.6).find("all 40"), std::string::npos);
    EXPECT_NE(schedule_sentence("auto", 16, 40, 0.6).find("20 of 40"), std::string::npos);
}

} // namespace
} // namespace viewer::test
