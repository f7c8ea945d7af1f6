// Cues that are heard, in sessions: what journal and tables say of them. When they begin is tested by clocks of the test in
// sound_timing_test.cpp, and measured in sound_slow_test.cpp.

#include "tests/viewer_trials/silent_speaker.h"

namespace viewer::test {
namespace {

class Sounds : public OnScreen {
protected:
    TemporaryFolder folder, speaker;
};

TEST_F(Sounds, AreInJournalTablesAndReport)
{
    SilentSpeaker device(speaker.path());
    if (!device.problem().empty()) GTEST_SKIP() << "SKIPPED: " << device.problem();
    device.record(folder / "kept.csv"); // a null sink that nobody records asks for nothing once it ran dry
    RunningSession run(folder, script_with("[{sound: beep, at: each_stimulus}]", 2,
                                           "{beep: {tone_hz: 1000, duration_ms: 40, ramp_ms: 1, level_db: -6}}"));
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    auto const trials = run.entries<study::TrialDone>();
    ASSERT_EQ(trials.size(), 4u);
    for (study::TrialDone const& t : trials) {
        ASSERT_EQ(t.sounds.size(), 1u);
        study::SoundPlayed const& s = t.sounds[0];
        ASSERT_TRUE(s.onset_s) << s.missing;
        EXPECT_EQ(s.sound, "beep");
        EXPECT_EQ(s.at, "a");
        EXPECT_EQ(s.event_s, t.shown.at(0).onset_s);
        EXPECT_NEAR(s.duration_s, 0.04, 1e-4);
    }
    auto const started = run.entries<study::SessionStarted>();
    std::map<std::string, std::string> about(started[0].about.begin(), started[0].about.end());
    for (char const* key : {"audio_device", "audio_host", "audio_rate_hz", "audio_latency_ms"})
        EXPECT_FALSE(about[key].empty()) << key;
    EXPECT_EQ(about["audio_onset_method"], "dac_time");

    // A recording that a device 12 ms late would give: it is compared with the journal.
    {
        std::ofstream recording(folder / "loop.csv");
        recording << "t_s,sound\n";
        constexpr double kRate = 8000;
        auto const heard = [&](double t) {
            return std::ranges::any_of(trials, [&](study::TrialDone const& trial) {
                double const since_s = t - *trial.sounds[0].onset_s - 0.012;
                return since_s >= 0 && since_s < 0.04;
            });
        };
        double const begin_s = *trials.front().sounds[0].onset_s - 0.5,
                     end_s = *trials.back().sounds[0].onset_s + 0.5;
        for (int i = 0; i < int(kRate * (end_s - begin_s)); ++i) {
            double const t = begin_s + i / kRate;
            recording << fmt::format("{:.6f},{}\n", t, heard(t) ? (i % 2 == 0 ? 0.5 : -0.5) : 0);
        }
    }
    std::string const session = "study photodiode loop.csv --sounds --session data/sub-P001/ses-01/beh --json ";
    Json const own = Json::parse(run_well(session, folder.path()).out);
    EXPECT_EQ(own.at("matched"), 4);
    EXPECT_EQ(own.at("missed"), 0);
    EXPECT_EQ(own.at("extra"), 0);
    EXPECT_LT(own.at("methods").at(0).at("jitter_sd_ms").get<double>(), 0.2);
    Json const lag = Json::parse(run_well(session + "--clock session --most-early-ms 100", folder.path()).out);
    EXPECT_NEAR(lag.at("methods").at(0).at("lag_mean_ms").get<double>(), 12, 0.2);

    run_well("study rebuild data --script x.yaml", folder.path());
    std::string const table = file_text(run.folder() / "sub-P001_ses-01_task-seen_acq-sounds_events.tsv");
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5);
    run_well("study report data --script x.yaml --out r.html", folder.path());
    EXPECT_NE(file_text(folder / "r.html").find(">Sounds<"), std::string::npos);
}

TEST_F(Sounds, OffsetsAndFilesAreKept)
{
    SilentSpeaker device(speaker.path());
    if (!device.problem().empty()) GTEST_SKIP() << "SKIPPED: " << device.problem();
    device.record(folder / "kept.csv"); // a null sink that nobody records asks for nothing once it ran dry
    std::string wav(
        "RIFF\x24\x0f\0\0WAVEfmt \x10\0\0\0\x01\0\x01\0\x40\x1f\0\0\x80\x3e\0\0\x02\0\x10\0data\0\x0f\0\0", 44);
    wav += std::string(0xf00, '\x40'); // 1920 samples of 8 kHz, 240 ms
    std::ofstream(folder / "word.wav", std::ios::binary) << wav;
    RunningSession run(
        folder, script_with("[{sound: word, at: first_stimulus, offset_ms: -200}, {sound: low, at: fixation}, "
                            "{sound: low, at: each_stimulus, offset_ms: 100}, {sound: low, offset_ms: 5000}]",
                            3, "{word: {file: word.wav, level_db: -3}, low: {tone_hz: 200, channel: left}}"));
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    auto const trials = run.entries<study::TrialDone>();
    ASSERT_EQ(trials.size(), 6u);
    for (study::TrialDone const& t : trials) {
        EXPECT_EQ(t.reason, "timeout");
        ASSERT_EQ(t.sounds.size(), 4u);
        EXPECT_EQ(t.sounds[0].at, "fixation");
        EXPECT_EQ(t.sounds[1].sound, "word");
        EXPECT_NEAR(t.sounds[1].duration_s, 0.24, 1e-3);
        for (std::size_t i = 0; i < 3; ++i) {
            ASSERT_TRUE(t.sounds[i].onset_s) << t.sounds[i].missing;
        }
        EXPECT_FALSE(t.sounds[3].onset_s);
        EXPECT_EQ(t.sounds[3].missing, "trial ended");
    }
    EXPECT_EQ(run.entries<study::SessionStarted>().at(0).about.back().first, "audio_onset_method");
}

TEST_F(Sounds, WithoutADeviceNeedAWord)
{
    std::string const home = speaker.path().string();
    char const* const before = std::getenv("HOME");
    setenv("HOME", home.c_str(), 1); // no asoundrc
    setenv("PULSE_SERVER", "unix:/nowhere", 1);
    std::string const text = script_with("[{sound: beep}]", 1, "{beep: {tone_hz: 1000}}");
    Outcome const refused = RunningSession(folder, text, "--audio nosuchdevice").wait();
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("there is no sound device"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("--audio none"), std::string::npos) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "data"));
    RunningSession run(folder, text, "--audio none");
    EXPECT_EQ(run.wait().code, 0);
    before ? setenv("HOME", before, 1) : unsetenv("HOME");
    unsetenv("PULSE_SERVER");
    for (study::TrialDone const& t : run.entries<study::TrialDone>()) {
        ASSERT_EQ(t.sounds.size(), 1u);
        EXPECT_EQ(t.sounds[0].missing, "without sound");
        EXPECT_NE(t.reason, "no_sound");
    }
    EXPECT_NE(run.entries<study::SessionStarted>().at(0).about.back().second.find("without sound"),
              std::string::npos);
}

} // namespace
} // namespace viewer::test
