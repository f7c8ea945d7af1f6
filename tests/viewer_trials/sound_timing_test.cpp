// When sounds begin, by clocks of the test: a device that is asked late, that reports wrong times, that runs dry.

#include "viewer/experiment/sound/buffer_times.h"
#include "viewer/experiment/sound/cue_player.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace viewer::test::sound_timing {
namespace {

constexpr int kRate = 48000;
constexpr std::size_t kFrames = 480; ///< 10 ms
constexpr double kClock_s = 1234.5;  ///< the device's clock is so much behind the steady one

/// A device whose buffers leave 30 ms after it asks for them in time.
struct Device {
    BufferTimes times{kRate};
    double leaves_s = 100; ///< of the next buffer, steady clock

    /// @param late_s  between the device's look at its clock and the call   @param wrong_s  error of its report
    /// @return error of the time that is found, s
    double ask(double late_s, double wrong_s = 0, bool has_underrun = false)
    {
        double const device_s = leaves_s - 0.03 - kClock_s;
        double const error_s = times.first_s({device_s + kClock_s + late_s, true, device_s,
                                              leaves_s - kClock_s + wrong_s, 0.5, has_underrun},
                                             kFrames) -
                               leaves_s;
        leaves_s += double(kFrames) / kRate;
        return error_s;
    }
};

TEST(BufferTimes, DoNotDependOnHowLateTheDeviceIsAnswered)
{
    Device device;
    std::mt19937 random(3);
    std::exponential_distribution<double> late(1 / 0.004); // a busy machine: 4 ms in the mean
    EXPECT_FALSE(device.times.is_known());
    for (int i = 0; i < 2000; ++i) {
        double const late_s = i < 10 || i % 20 != 0 ? late(random) : 1e-5; // of two seconds some are in time
        double const error_s = device.ask(late_s);
        EXPECT_GE(error_s, -1e-9) << i;
        if (i > 100) {
            EXPECT_LT(error_s, 3e-5) << i;
        }
    }
}

/// Reports are wrong by up to a millisecond: the median of 64 has a standard error of 1 / (2 x 0.5 x 8) ms.
TEST(BufferTimes, AreTheMedianOfTheReports)
{
    Device device;
    std::mt19937 random(4);
    std::uniform_real_distribution<double> wrong(-1e-3, 1e-3);
    for (int i = 0; i < 1000; ++i) {
        double const error_s = device.ask(0, i % 50 == 7 ? 0.015 : wrong(random));
        if (i > 64) {
            EXPECT_LT(std::abs(error_s), 5 * 0.125e-3) << i;
        }
    }
}

TEST(BufferTimes, BeginAnewAfterSilence)
{
    Device device;
    for (int i = 0; i < 100; ++i) device.ask(0);
    device.leaves_s += 0.008; // as short a silence is within the spread of reports: the device says it
    EXPECT_NEAR(device.ask(0, 0, true), 0, 1e-9);
    device.leaves_s += 0.05; // this one it does not say
    EXPECT_NEAR(device.ask(0), 0, 1e-9);
}

TEST(BufferTimes, WithoutAClockAreThoseOfTheLatency)
{
    BufferTimes times(kRate);
    for (int i = 0; i < 100; ++i)
        EXPECT_NEAR(times.first_s({50 + 0.01 * i, false, 0, 0, 0.02, false}, kFrames), 50.02 + 0.01 * i, 1e-9);
}

std::shared_ptr<SoundSamples const> ones(std::size_t frames)
{
    return std::make_shared<SoundSamples const>(SoundSamples{std::vector<float>(2 * frames, 0.75f), kRate});
}

struct Mixer : SoundMixer {
    double lead_s() const override { return 0.03; }
    bool is_running() const override { return true; }
};

/// A mixer that plays buffer after buffer, from 100 s on.
struct Played {
    Mixer mixer;
    std::vector<float> out; ///< interleaved
    void buffers(int count)
    {
        for (; count > 0; --count) {
            double const first_s = 100 + double(out.size() / 2) / kRate;
            out.resize(out.size() + 2 * kFrames);
            mixer.fill(&out[out.size() - 2 * kFrames], kFrames, first_s, kRate);
        }
    }
    std::size_t first_heard() const
    {
        return std::size_t(std::find_if(out.begin(), out.end(), [](float v) { return v != 0; }) - out.begin()) / 2;
    }
};

TEST(SoundMixer, SoundsBeginAtTheirSampleAndSaySo)
{
    Played p;
    p.buffers(2);
    auto const ticket = p.mixer.start(ones(1000), 100.0375); // 1800 frames
    ASSERT_TRUE(ticket);
    p.buffers(1);
    EXPECT_FALSE(p.mixer.report(*ticket).onset_s);
    p.buffers(5);
    EXPECT_EQ(p.first_heard(), 1800u);
    EXPECT_NEAR(*p.mixer.report(*ticket).onset_s, 100.0375, 1e-9);
    EXPECT_EQ(std::count(p.out.begin(), p.out.end(), 0.75f), 2000);
    EXPECT_EQ(p.out[2 * 2799], 0.75f);
    EXPECT_EQ(p.mixer.clipped(), 0u);
}

TEST(SoundMixer, WhatIsStartedLateBeginsWithTheNextBufferAndSaysSo)
{
    Played p;
    p.buffers(3);
    auto const ticket = p.mixer.start(ones(100), 100.005);
    p.buffers(1);
    EXPECT_EQ(p.first_heard(), 3 * kFrames);
    EXPECT_NEAR(*p.mixer.report(*ticket).onset_s, 100.03, 1e-9);
}

TEST(SoundMixer, WhatIsReleasedBeforeItBeganIsNotPlayedAndWhatPlaysEnds)
{
    Played p;
    auto const first = p.mixer.start(ones(700), 100.001), never = p.mixer.start(ones(700), 100.02);
    p.buffers(1);
    p.mixer.release(*first);
    p.mixer.release(*never);
    p.buffers(4);
    EXPECT_EQ(std::count(p.out.begin(), p.out.end(), 0.75f), 1400);
    for (int i = 0; i < 16; ++i) EXPECT_TRUE(p.mixer.start(ones(1), 200)) << "all voices are free again";
    EXPECT_FALSE(p.mixer.start(ones(1), 200)) << "too many";
}

TEST(SoundMixer, SoundsThatOverlapAreCutAtFullScaleAndCounted)
{
    Played p;
    p.mixer.start(ones(200), 100);
    p.mixer.start(ones(200), 100 + 100.0 / kRate);
    p.buffers(1);
    EXPECT_EQ(p.out[2 * 150], 1);
    EXPECT_EQ(p.mixer.clipped(), 200u) << "100 frames of two channels";
}

TEST(CuePlayer, SoundsBeginAtTheirOffsetFromTheMoment)
{
    study::Script script;
    script.sounds.resize(1);
    script.sounds[0].name = "tone";
    study::Block block;
    block.cues = {{0, study::CueMoment::each_stimulus, -20},
                  {0, study::CueMoment::each_stimulus, 40},
                  {0, study::CueMoment::fixation, 0}};
    SoundBank const sounds{ones(480)};
    Played p;
    CuePlayer player(script, block, &p.mixer, sounds);
    EXPECT_NEAR(player.lead_s(study::CueMoment::each_stimulus), 0.05, 1e-12);
    player.start(study::CueMoment::each_stimulus, true, "stimulus 1", 100.1);
    p.buffers(20);
    player.came(100.101);
    auto const played = player.take(100.2);
    ASSERT_EQ(played.size(), 2u);
    EXPECT_EQ(p.first_heard(), 3840u);
    EXPECT_NEAR(played[0].onset_s.value_or(0), 100.08, 1e-9);
    EXPECT_NEAR(played[1].onset_s.value_or(0), 100.14, 1e-9);
    for (study::SoundPlayed const& s : played) {
        EXPECT_EQ(s.sound, "tone");
        EXPECT_EQ(s.at, "stimulus 1");
        EXPECT_EQ(s.event_s, 100.101); // when the moment came, not when it was planned
        EXPECT_EQ(s.duration_s, 0.01);
        EXPECT_TRUE(s.missing.empty());
    }
}

} // namespace
} // namespace viewer::test::sound_timing
