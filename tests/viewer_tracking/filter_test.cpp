// One-euro filter, rotations as vectors, clock, latency.

#include "gi/core/one_euro.h"
#include "gi/core/pose.h"
#include "tests/viewer_tracking/pose_checks.h"
#include "viewer/devices/tracking/arrival_clock.h"
#include "viewer/devices/tracking/clock_offset.h"
#include "viewer/devices/tracking/latency.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

namespace viewer::test {
namespace {

TEST(OneEuro, StepResponseIsThatOfALowPass)
{
    // beta = 0: y_n = 1 - (1 - alpha)^n with alpha = dt / (dt + tau), tau = 1 / (2 pi fc).
    gi::OneEuroSettings const s{2, 0, 1, 1, 6};
    double const dt = 0.01, tau = 1 / (2 * 3.14159265358979 * 2), alpha = dt / (dt + tau);
    gi::OneEuroPosition p = gi::start(gi::dvec3(0));
    gi::OneEuroRotation r = gi::start(gi::dquat(1, 0, 0, 0));
    for (int n = 1; n < 50; ++n) {
        p = step(s, p, {1, -2, 3}, dt);
        r = step(s, r, gi::exp_rotation({0, 1, 0}), dt);
        double const expected = 1 - std::pow(1 - alpha, n);
        EXPECT_NEAR(p.value.z, 3 * expected, 1e-12);
        EXPECT_NEAR(gi::log_rotation(r.value).y, expected, 1e-12);
    }
}

TEST(OneEuro, LagOfAConstantMotionIsTau)
{
    gi::OneEuroSettings const s{1.5, 4, 1, 1, 6};
    gi::dvec3 const v{0.5, 0, -1.2}, turn{0, 1.5, 0};
    gi::OneEuroPosition p = gi::start(gi::dvec3(0));
    gi::OneEuroRotation r = gi::start(gi::dquat(1, 0, 0, 0));
    double t = 0;
    for (int i = 0; i < 600; ++i) {
        t += 1 / 60.0;
        p = step(s, p, v * t, 1 / 60.0);
        r = step(s, r, gi::exp_rotation(turn * t), 1 / 60.0);
    }
    EXPECT_LT(glm::distance(p.velocity, v), 1e-6);
    EXPECT_LT(glm::distance(r.velocity, turn), 1e-6);
    EXPECT_LT(glm::distance(p.value + v * p.lag_s, v * t), 1e-6) << "value plus lag is the motion";
    EXPECT_LT(angle_between(r.value * gi::exp_rotation(r.velocity * r.lag_s), gi::exp_rotation(turn * t)), 1e-6);
    EXPECT_NEAR(p.lag_s, 1 / (2 * 3.14159265358979 * (1.5 + 4 * 1.3)), 1e-6);
}

/// What stands has an end, to the last bit: pictures refine from then on.
TEST(OneEuro, ArrivesWhereABodyStands)
{
    gi::OneEuroSettings const s{1, 5, 1, 0.3, 16};
    gi::dvec3 const to{0.15, -0.02, 1e-3};
    gi::dquat const turned = gi::exp_rotation({0.2, 0, -0.1});
    gi::OneEuroPosition p = gi::start(gi::dvec3(0));
    gi::OneEuroRotation r = gi::start(gi::dquat(1, 0, 0, 0));
    for (int n = 0; n < 400; ++n) { // 8 s
        p = step(s, p, to, 0.02);
        r = step(s, r, turned, 0.02);
    }
    EXPECT_EQ(p.value, to);
    EXPECT_EQ(p.velocity, gi::dvec3{0});
    EXPECT_EQ(r.value, turned);
    EXPECT_EQ(r.velocity, gi::dvec3{0});
}

TEST(OneEuro, RestIsQuietAndMotionIsQuick)
{
    gi::OneEuroSettings const s{1, 4, 1, 1, 6};
    std::mt19937 rng(7);
    std::normal_distribution<double> noise(0, 0.001);
    gi::OneEuroPosition p = gi::start(gi::dvec3(0));
    double in = 0, out = 0;
    for (int i = 0; i < 6000; ++i) {
        double const x = noise(rng);
        p = step(s, p, {x, 0, 0}, 1 / 60.0);
        if (i < 100) continue;
        in += x * x;
        out += p.value.x * p.value.x;
    }
    // A first-order low-pass leaves alpha / (2 - alpha) of white noise; the cutoff is a little above its least.
    EXPECT_LT(std::sqrt(out / in), 0.28);
}

TEST(ArrivalClock, SmoothsJitter)
{
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> jitter(0, 0.05);
    std::vector<double> arrivals;
    for (int i = 0; i < 3000; ++i) arrivals.push_back(i / 60.0 + jitter(rng));
    std::sort(arrivals.begin(), arrivals.end());
    ArrivalClock clock;
    double before = 0, rms = 0;
    for (std::size_t i = 0; i < arrivals.size(); ++i) {
        double const t = clock.note(arrivals[i]);
        EXPECT_GT(t, before);
        if (i >= 500) {
            rms += std::pow(t - before - 1 / 60.0, 2);
            EXPECT_NEAR(t, double(i) / 60 + 0.025, 0.02);
        }
        before = t;
    }
    EXPECT_LT(std::sqrt(rms / 2500), 0.003);
    EXPECT_EQ(clock.note(100), 100.0) << "after a pause";
}

TEST(OneWayClockOffset, IsTheFastestPackets)
{
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> jitter(0, 0.05);
    OneWayClockOffset clock;
    double const offset = 1e6, drift = 1e-4; // 100 ppm
    for (int i = 0; i < 60 * 60; ++i) {
        double const sent = i / 60.0;
        clock.note(sent, sent * (1 + drift) + offset + 0.004 + jitter(rng));
    }
    // Drift of 100 ppm over the window of 8 s is 0.8 ms, the fastest of 480 is 0.1 ms late.
    EXPECT_NEAR(clock.offset_s(), offset + 0.004 + 60 * drift, 0.0012);
    EXPECT_EQ(clock.restarts() + clock.doubtful(), 0u);
}

TEST(OneWayClockOffset, BelievesAStepOnlyIfItIsRepeated)
{
    OneWayClockOffset clock;
    for (int i = 0; i < 100; ++i) EXPECT_EQ(clock.note(i * 0.01, 5 + i * 0.01), ClockNote::fits);
    EXPECT_EQ(clock.note(2, 6.01), ClockNote::doubtful) << "one second ahead";
    EXPECT_EQ(clock.note(1.02, 6.02), ClockNote::fits);
    EXPECT_NEAR(clock.offset_s(), 5, 1e-9);
    EXPECT_EQ(clock.note(-86398.97, 6.03), ClockNote::doubtful) << "midnight";
    EXPECT_EQ(clock.note(-86398.96, 6.04), ClockNote::was_set);
    EXPECT_NEAR(clock.offset_s(), 86405, 1e-6);
    EXPECT_EQ(clock.note(-86398.95, 6.05), ClockNote::fits);
    EXPECT_EQ(clock.restarts(), 1u);
}

TEST(Latency, PercentilesOfKnownDelays)
{
    LatencyMeter meter;
    for (int i = 0; i < 1000; ++i) {
        double const sent = i * 0.02;
        meter.note(sent + 3 + 0.001 * (i % 100), sent);
    }
    Latency const l = meter.estimate();
    EXPECT_EQ(l.packets, 1000u);
    EXPECT_NEAR(l.offset_s, 3, 1e-9);
    EXPECT_NEAR(l.delay_p50_ms, 49.5, 1e-6);
    EXPECT_NEAR(l.delay_p95_ms, 94.05, 1e-6);
    EXPECT_NEAR(l.delay_max_ms, 99, 1e-6);
    EXPECT_NEAR(l.rate_hz, 50, 0.3);
    EXPECT_NEAR(l.interval_p50_ms, 21, 1e-6);
    EXPECT_EQ(numbers(l).size(), 10u);
    EXPECT_EQ(LatencyMeter().estimate().packets, 0u);
}

} // namespace
} // namespace viewer::test
