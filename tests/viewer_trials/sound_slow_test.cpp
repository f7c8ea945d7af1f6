// Cues that are heard: their onsets in the journal against a recording of the sound device, by the clock of a machine that
// does nothing else.

#include "tests/viewer_trials/silent_speaker.h"

#include <cmath>

namespace viewer::test {
namespace {

class MeasuredSounds : public OnScreen {
protected:
    TemporaryFolder folder, speaker;
};

TEST_F(MeasuredSounds, BeginWhenTheJournalSays)
{
    SilentSpeaker device(speaker.path());
    if (!device.problem().empty()) GTEST_SKIP() << "SKIPPED: " << device.problem();
    device.record(folder / "loop.csv");
    sleep_ms(500);
    RunningSession run(folder, script_with("[{sound: beep, at: each_stimulus}]", 30,
                                           "{beep: {tone_hz: 1000, duration_ms: 40, ramp_ms: 1, level_db: -6}}"));
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    sleep_ms(500);
    device.stop_recording();
    for (int i = 0; i < 300 && !std::filesystem::exists(folder / "loop.csv"); ++i) sleep_ms(100);
    auto const trials = run.entries<study::TrialDone>();
    ASSERT_EQ(trials.size(), 60u);
    std::vector<double> errors_ms;
    for (study::TrialDone const& t : trials) {
        ASSERT_EQ(t.sounds.size(), 1u);
        study::SoundPlayed const& s = t.sounds[0];
        ASSERT_TRUE(s.onset_s) << s.missing;
        errors_ms.push_back(*study::error_ms(s));
    }
    std::sort(errors_ms.begin(), errors_ms.end());
    fmt::print("60 cues at stimuli: {:.2f} ms (median) from the picture, {:.2f} to {:.2f}\n", errors_ms[30],
               errors_ms.front(), errors_ms.back());
    EXPECT_LT(std::abs(errors_ms[30]), 20) << "one refresh of 50 Hz: the picture's own time is known no better";

    // Compares the recording with the journal: jitter by its own clock, lag by the session's.
    std::string const session = "study photodiode loop.csv --sounds --session data/sub-P001/ses-01/beh --json ";
    Json const own = Json::parse(run_well(session, folder.path()).out);
    EXPECT_EQ(own.at("matched"), 60);
    EXPECT_EQ(own.at("missed"), 0);
    EXPECT_EQ(own.at("extra"), 0);
    double const jitter_ms = own.at("methods").at(0).at("jitter_sd_ms").get<double>();
    Json const lag = Json::parse(run_well(session + "--clock session --most-early-ms 100", folder.path()).out);
    Json const& by_session = lag.at("methods").at(0);
    fmt::print(
        "60 cues against the recording: jitter {:.3f} ms (sd), drift {:.0f} ppm; lag by the session's clock "
        "{:.2f} ms (sd {:.2f})\n",
        jitter_ms, own.at("drift_ppm").get<double>(), by_session.at("lag_mean_ms").get<double>(),
        by_session.at("jitter_sd_ms").get<double>());
    EXPECT_LT(jitter_ms, 1);
    EXPECT_LT(std::abs(by_session.at("lag_mean_ms").get<double>()), 30) << "PulseAudio's blocks";
}

} // namespace
} // namespace viewer::test
