#include "viewer/protocol/cluster/clock_offset.h"
#include "viewer/protocol/cluster/swap_log.h"

#include <gtest/gtest.h>
#include <random>

namespace viewer::test {
namespace {

/// A message there and back through a network with its delays, to a clock that is `ahead`.
Echo trip(double at, double there, double back, double ahead, double& returned)
{
    Echo e{at, at + there + ahead, at + there + ahead + 1e-3};
    returned = at + there + 1e-3 + back;
    return e;
}

TEST(RoundTripClockOffset, KnowsNothingBeforeTheFirstMessage) { EXPECT_FALSE(RoundTripClockOffset().estimate()); }

TEST(RoundTripClockOffset, EqualWaysAreExact)
{
    RoundTripClockOffset clock;
    double back = 0;
    Echo const e = trip(100, 2e-3, 2e-3, -7.5, back);
    clock.add(e, back);
    EXPECT_NEAR(clock.estimate()->ahead_s, -7.5, 1e-12);
    EXPECT_NEAR(clock.estimate()->error_s, 2e-3, 1e-12);
}

TEST(RoundTripClockOffset, IsWithinItsErrorWhateverTheWays)
{
    std::mt19937 random(5);
    std::exponential_distribution<double> late(1e3);
    RoundTripClockOffset clock;
    for (int k = 0; k < 1000; ++k) {
        double back = 0, const_ahead = 12.25;
        Echo const e = trip(k, 1e-5 + late(random), 1e-5 + late(random), const_ahead, back);
        clock.add(e, back);
        auto const now = *clock.estimate();
        ASSERT_LE(std::abs(now.ahead_s - const_ahead), now.error_s + 1e-9) << k;
    }
    EXPECT_LT(clock.estimate()->error_s, 2e-4); // of 256 trips one is quick
}

TEST(RoundTripClockOffset, FollowsADrift)
{
    RoundTripClockOffset clock;
    double ahead = 0, back = 0;
    for (int k = 0; k < 20000; ++k) { // 60 Hz, 20 parts in a million: 6.7 ms in all
        ahead = 20e-6 * k / 60;
        Echo const e = trip(k / 60.0, 1e-5, 1e-5, ahead, back);
        clock.add(e, back);
    }
    EXPECT_NEAR(clock.estimate()->ahead_s, ahead, 256 / 60.0 * 20e-6);
}

TEST(SwapLog, MeasuresFromTheFirstToTheLast)
{
    SwapLog log;
    for (std::uint64_t frame = 0; frame < 100; ++frame) {
        double const t = 10 + double(frame) / 60;
        log.add(frame, t, 0);
        if (frame > 0) log.add(frame - 1, t - 1 / 60.0 + 1e-5 * double(frame), 1e-6); // a frame late
        if (frame > 0) log.add(frame - 1, t - 1 / 60.0 - 1e-3, 2e-6);
    }
    SwapSkew const s = log.skew();
    EXPECT_EQ(s.frames, 99u);
    EXPECT_NEAR(s.median_s, 1e-3 + 50e-5, 1e-8);
    EXPECT_NEAR(s.p95_s, 1e-3 + 94.1e-5, 1e-8);
    EXPECT_NEAR(s.most_s, 1e-3 + 99e-5, 1e-8);
    EXPECT_EQ(s.clock_error_s, 2e-6);
    EXPECT_NE(to_text(s).find("swap skew of 99 frames"), std::string::npos);
}

TEST(SwapLog, OneRankHasNoSkew)
{
    SwapLog log;
    for (std::uint64_t frame = 0; frame < 9; ++frame) log.add(frame, double(frame), 0);
    EXPECT_EQ(log.skew().frames, 0u);
    EXPECT_EQ(log.skew().most_s, 0);
}

} // namespace
} // namespace viewer::test
