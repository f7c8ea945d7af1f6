// Signals with known lag, jitter, drift, noise, missing and doubled flashes.

#include "gi/core/error.h"
#include "study/signals/photodiode.h"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <random>

namespace study::test {
namespace {

struct MadeSignal {
    double lag_ms = 12.5, jitter_ms = 0.8, drift_ppm = 40, noise = 0.05, offset_s = 17.3, rate_hz = 8000;
    double pwm_hz = 0; ///< of the backlight
    int onsets = 120;
    std::vector<int> missing, doubled;
    DiodeClock clock = DiodeClock::own;
};

struct Made {
    DiodeSignal signal;
    std::vector<ReportedOnset> onsets;
    double lag_mean_ms = 0, lag_sd_ms = 0; ///< of the flashes made
};

Made make(MadeSignal const& m)
{
    std::mt19937 random(20261126);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> pause(1.0, 2.0);
    Made out;
    std::vector<std::pair<double, double>> flashes, triggers; // recorder's clock
    double t = 5;
    auto const recorder = [&](double s) {
        return m.clock == DiodeClock::session ? s : m.offset_s + s * (1 + 1e-6 * m.drift_ppm);
    };
    std::vector<double> lags;
    for (int i = 0; i < m.onsets; ++i, t += pause(random)) {
        out.onsets.push_back({t, 0.5, 8.3, i % 3 == 0 ? "swap_finish" : "oml", fmt::format("step {}", i)});
        triggers.emplace_back(recorder(t), recorder(t + 0.1));
        if (std::find(m.missing.begin(), m.missing.end(), i) != m.missing.end()) continue;
        double const lag_ms = m.lag_ms + m.jitter_ms * normal(random);
        lags.push_back(lag_ms);
        double const from = recorder(t + 1e-3 * lag_ms);
        if (std::find(m.doubled.begin(), m.doubled.end(), i) != m.doubled.end()) {
            flashes.emplace_back(from, from + 0.1);
            flashes.emplace_back(from + 0.2, from + 0.5);
        } else {
            flashes.emplace_back(from, from + 0.5);
        }
    }
    for (double const v : lags) out.lag_mean_ms += v / double(lags.size());
    for (double const v : lags) out.lag_sd_ms += std::pow(v - out.lag_mean_ms, 2) / double(lags.size() - 1);
    out.lag_sd_ms = std::sqrt(out.lag_sd_ms);
    out.signal.rate_hz = m.rate_hz;
    double const end = recorder(t) + 1;
    std::size_t f = 0, g = 0;
    for (double s = 0; s < end; s += 1 / m.rate_hz) {
        while (f < flashes.size() && flashes[f].second < s) ++f;
        while (g < triggers.size() && triggers[g].second < s) ++g;
        double v = f < flashes.size() && s >= flashes[f].first ? 1 : 0;
        if (m.pwm_hz > 0 && v > 0) v = std::fmod(s * m.pwm_hz, 1) < 0.6;
        out.signal.time_s.push_back(s);
        out.signal.light.push_back(0.1 + 0.5 * v + 0.5 * m.noise * normal(random));
        if (m.clock == DiodeClock::trigger)
            out.signal.trigger.push_back(g < triggers.size() && s >= triggers[g].first ? 1 : 0);
    }
    return out;
}

LagSummary all_of(DiodeResult const& r)
{
    for (LagSummary const& s : r.methods)
        if (s.method == "all") return s;
    return r.methods.front();
}

TEST(Photodiode, MeasuresLagAndJitterWithTheSessionsClock)
{
    MadeSignal m;
    m.clock = DiodeClock::session;
    m.drift_ppm = 0;
    Made const made = make(m);
    DiodeSettings settings;
    settings.clock = DiodeClock::session;
    DiodeResult const r = compare_with_onsets(made.signal, made.onsets, settings);
    LagSummary const all = all_of(r);
    fmt::print("session's clock: lag {:.3f} ms (true {:.3f}), jitter {:.3f} (true {:.3f}), of {}\n", all.mean_ms,
               made.lag_mean_ms, all.sd_ms, made.lag_sd_ms, all.count);
    EXPECT_EQ(all.count, 120);
    EXPECT_NEAR(all.mean_ms, made.lag_mean_ms, 0.05);
    EXPECT_NEAR(all.sd_ms, made.lag_sd_ms, 0.05);
    EXPECT_EQ(r.methods.size(), 3u) << "oml, swap_finish, all";
    EXPECT_TRUE(r.missed.empty());
    EXPECT_EQ(r.extra, 0);
    EXPECT_NEAR(r.matched[0].duration_ms, 500, 1);
}

TEST(Photodiode, FindsDriftJitterAndMissingFlashesWithItsOwnClock)
{
    MadeSignal m;
    m.missing = {7, 8, 50};
    m.doubled = {20, 99};
    m.drift_ppm = -120;
    m.onsets = 300;
    Made const made = make(m);
    DiodeResult const r = compare_with_onsets(made.signal, made.onsets, {});
    LagSummary const all = all_of(r);
    fmt::print("own clock: drift {:.1f} +- {:.1f} ppm (true -120), jitter {:.3f} ms (true {:.3f}), {} missed, {} "
               "doubled\n",
               r.drift_ppm, r.drift_se_ppm, all.sd_ms, made.lag_sd_ms, r.missed.size(), r.doubled.size());
    EXPECT_EQ(r.missed, (std::vector<std::size_t>{7, 8, 50}));
    EXPECT_EQ(r.doubled, (std::vector<std::size_t>{20, 99}));
    EXPECT_EQ(r.extra, 0);
    EXPECT_NEAR(r.drift_ppm, -120, 4 * r.drift_se_ppm);
    EXPECT_LT(r.drift_se_ppm, 1);
    EXPECT_NEAR(all.sd_ms, made.lag_sd_ms, 0.05);
    EXPECT_TRUE(std::isnan(all.mean_ms)) << "a clock of its own does not say when the program swapped";
}

TEST(Photodiode, MeasuresTheLagAgainstATriggerChannel)
{
    MadeSignal m;
    m.clock = DiodeClock::trigger;
    m.missing = {3};
    Made const made = make(m);
    DiodeSettings settings;
    settings.clock = DiodeClock::trigger;
    DiodeResult const r = compare_with_onsets(made.signal, made.onsets, settings);
    EXPECT_NEAR(all_of(r).mean_ms, made.lag_mean_ms, 0.1) << "the trigger has no noise, but whole samples";
    EXPECT_NEAR(all_of(r).sd_ms, made.lag_sd_ms, 0.05);
    EXPECT_NEAR(r.drift_ppm, 40, 2);
    EXPECT_EQ(r.missed, (std::vector<std::size_t>{3}));
}

TEST(Photodiode, SeesThroughPulsedBacklightsAndNoise)
{
    MadeSignal m;
    m.clock = DiodeClock::session;
    m.drift_ppm = 0;
    m.pwm_hz = 240;
    m.noise = 0.2;
    m.onsets = 60;
    Made const made = make(m);
    DiodeSettings settings;
    settings.clock = DiodeClock::session;
    DiodeResult const r = compare_with_onsets(made.signal, made.onsets, settings);
    EXPECT_EQ(all_of(r).count, 60);
    EXPECT_TRUE(r.doubled.empty()) << r.doubled.size();
    // A flash begins with the first pulse in it: up to 1.7 ms late.
    EXPECT_NEAR(all_of(r).mean_ms, made.lag_mean_ms + 0.4, 0.6);
}

TEST(Photodiode, RefusesWhatIsNoRecordingOfThisSession)
{
    MadeSignal m;
    m.onsets = 30;
    Made made = make(m);
    std::vector<ReportedOnset> others = made.onsets;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> pause(0.7, 3);
    double t = 0;
    for (ReportedOnset& o : others) o.time_s = t += pause(random);
    EXPECT_THROW(compare_with_onsets(made.signal, others, {}), gi::InputError);
    EXPECT_THROW(compare_with_onsets(made.signal, {}, {}), gi::InputError);
    DiodeSettings trigger;
    trigger.clock = DiodeClock::trigger;
    EXPECT_THROW(compare_with_onsets(made.signal, made.onsets, trigger), gi::InputError);
    std::normal_distribution<double> normal;
    for (double& v : made.signal.light) v = normal(random);
    EXPECT_THROW(compare_with_onsets(made.signal, made.onsets, {}), gi::InputError) << "noise";
}

template <class T>
void put(std::string& to, T value)
{
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    to.append(bytes, sizeof value);
}

TEST(DiodeFiles, ReadsWavOfTwoChannels)
{
    std::string data;
    for (int i = 0; i < 100; ++i) {
        put(data, std::int16_t(i * 100));
        put(data, std::int16_t(-i));
    }
    std::string wav = "RIFF";
    put(wav, std::uint32_t(36 + data.size()));
    wav += "WAVEfmt ";
    put(wav, std::uint32_t(16));
    put(wav, std::uint16_t(1));
    put(wav, std::uint16_t(2));
    put(wav, std::uint32_t(44100));
    put(wav, std::uint32_t(44100 * 4));
    put(wav, std::uint16_t(4));
    put(wav, std::uint16_t(16));
    wav += "data";
    put(wav, std::uint32_t(data.size()));
    wav += data;
    DiodeSignal const s = read_wav(wav, "a.wav");
    ASSERT_EQ(s.light.size(), 100u);
    EXPECT_EQ(s.rate_hz, 44100);
    EXPECT_DOUBLE_EQ(s.light[50], 5000 / 32768.0);
    EXPECT_DOUBLE_EQ(s.trigger[50], -50 / 32768.0);
    EXPECT_EQ(read_wav(wav.substr(0, wav.size() - 41), "a.wav").light.size(), 89u) << "cut off";
    for (std::size_t n = 0; n < 44; ++n) EXPECT_THROW(read_wav(wav.substr(0, n), "a.wav"), gi::InputError) << n;
    wav[20] = 7; // mu-law
    EXPECT_THROW(read_wav(wav, "a.wav"), gi::InputError);
}

TEST(DiodeFiles, ReadsCsvAndNamesTheLineOfAMistake)
{
    DiodeSignal const s = read_diode_csv("t_ms,light\n0,1\n1,2\n2,3\n", "a.csv");
    EXPECT_DOUBLE_EQ(s.time_s[2], 0.002);
    EXPECT_NEAR(s.rate_hz, 1000, 1e-6);
    for (auto const& [text, line] :
         {std::pair{"a,b\n", "a.csv:1:"}, {"t_s,light\n0,1\n0,2\n", "a.csv:3:"}, {"t_s,light\n0,x\n", "a.csv:2:"}})
        try {
            read_diode_csv(text, "a.csv");
            ADD_FAILURE() << text;
        } catch (gi::InputError const& e) {
            EXPECT_EQ(std::string(e.what()).substr(0, 8), line) << e.what();
        }
}

/// Tones of 40 ms with ramps of 1 ms at these times of a recording of 48 kHz; a little noise.
DiodeSignal tones_at(std::vector<double> const& times_s, double length_s, double noise)
{
    DiodeSignal s;
    s.rate_hz = 48000;
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i < int(length_s * s.rate_hz); ++i) {
        double const t = i / s.rate_hz;
        double v = noise * normal(random);
        for (double const at : times_s)
            if (t >= at && t < at + 0.04)
                v +=
                    0.5 * std::min({1.0, (t - at) / 1e-3, (at + 0.04 - t) / 1e-3}) * std::sin(6283.185 * (t - at));
        s.time_s.push_back(t);
        s.light.push_back(v);
    }
    return s;
}

TEST(HeardSounds, BeginWhereTheRecordingGetsLoud)
{
    std::vector<double> at;
    std::vector<ReportedOnset> onsets;
    for (int i = 0; i < 20; ++i) {
        at.push_back(0.3 + 0.31 * i + 0.001 * (i * i % 7));
        onsets.push_back({at.back() - 0.012, 0.04, 0, "sound", "x"});
    }
    DiodeSettings settings;
    settings.clock = DiodeClock::session;
    DiodeResult const r = compare_with_onsets(heard(tones_at(at, 7, 0.001), 0.05, 10), onsets, settings);
    ASSERT_EQ(r.matched.size(), 20u);
    EXPECT_EQ(r.extra, 0);
    EXPECT_NEAR(r.methods[0].mean_ms, 12, 0.15);
    EXPECT_LT(r.methods[0].sd_ms, 0.05);
}

TEST(HeardSounds, AreRefusedInNoiseAndSilence)
{
    EXPECT_THROW(heard(tones_at({0.3}, 1, 0.05), 0.05, 10), gi::InputError);
    EXPECT_THROW(heard(tones_at({}, 1, 0), 0.05, 10), gi::InputError);
}

} // namespace
} // namespace study::test
