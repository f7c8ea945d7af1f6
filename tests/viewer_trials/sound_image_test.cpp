// Cues that are heard: their onsets in the journal against a recording of the sound device.

#include "tests/support/xvfb.h"
#include "tests/viewer_trials/measured_session.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <signal.h>

namespace viewer::test {
namespace {

/// A PulseAudio of its own with a sink that plays nowhere and can be recorded: the default device of ALSA.
class SilentSpeaker {
public:
    explicit SilentSpeaker(std::filesystem::path const& folder) : folder_(folder)
    {
        if (gi::test::run_shell("command -v pulseaudio parec > /dev/null") != 0) {
            problem_ = "pulseaudio is not installed (scripts/setup --tests installs it)";
            return;
        }
        std::filesystem::create_directories(folder_ / "run");
        std::ofstream(folder_ / ".asoundrc") << "pcm.!default { type pulse }\nctl.!default { type pulse }\n";
        set("HOME", folder_.string());
        set("XDG_RUNTIME_DIR", (folder_ / "run").string());
        set("PULSE_COOKIE", (folder_ / "cookie").string());
        set("PULSE_SERVER", "unix:" + (folder_ / "native").string());
        start(
            "pulseaudio -n --daemonize=no --use-pid-file=no --exit-idle-time=-1 --disable-shm=yes --realtime=no "
            "-L 'module-null-sink sink_name=test rate=48000 channels=2' -L 'module-native-protocol-unix socket=" +
            (folder_ / "native").string() + " auth-anonymous=1'");
        for (int i = 0; i < 100 && !std::filesystem::exists(folder_ / "native"); ++i) sleep_ms(50);
        if (!std::filesystem::exists(folder_ / "native")) problem_ = "pulseaudio does not start here";
    }
    ~SilentSpeaker()
    {
        for (std::string const& pid : pids_) gi::test::run_shell("kill " + pid + " 2> /dev/null");
        for (auto const& [name, value] : before_)
            value ? setenv(name.c_str(), value->c_str(), 1) : unsetenv(name.c_str());
    }
    SilentSpeaker(SilentSpeaker const&) = delete;
    SilentSpeaker& operator=(SilentSpeaker const&) = delete;

    std::string const& problem() const { return problem_; }
    /// Records what it plays until the end, as record.py says.
    void record(std::filesystem::path const& to)
    {
        start("python3 '" LIGHTWELL_SOURCE_DIR "/tests/viewer_trials/record_sound.py' '" + to.string() + "'");
    }
    void stop_recording() { gi::test::run_shell("kill -INT " + pids_.back()); }

private:
    void start(std::string const& command)
    {
        std::string const pid = (folder_ / "pid").string();
        gi::test::run_shell("exec " + command + " > '" + (folder_ / "log").string() + "' 2>&1 & echo $! > '" +
                            pid + "'");
        std::string number = file_text(pid);
        number.erase(std::remove(number.begin(), number.end(), '\n'), number.end());
        pids_.push_back(number);
    }
    void set(char const* name, std::string const& value)
    {
        char const* const old = std::getenv(name);
        before_.emplace_back(name, old ? std::optional<std::string>(old) : std::nullopt);
        setenv(name, value.c_str(), 1);
    }

    std::filesystem::path folder_;
    std::string problem_;
    std::vector<std::string> pids_;
    std::vector<std::pair<std::string, std::optional<std::string>>> before_;
};

class Sounds : public OnScreen {
protected:
    TemporaryFolder folder, speaker;
};

std::string script_with(std::string const& cues, int repeats, std::string const& sounds)
{
    return fmt::format(R"(schema: study/1
id: heard
seed: 4
participants: {{count: 1}}
timing: {{vsync: record, expected_hz: 50, calibrate: {{frames: 50}}, max_dropped_frames: 1000, on_bad_trial: keep}}
factors: {{bounces: [0, 2]}}
defaults: {{settings: {{method: slhb, scene: cornell, paths: 1, scale: 1}}, iti_ms: 250, isi_ms: 250, stimulus_ms: 60}}
sounds: {}
sequence: [seen]
blocks:
  seen: {{task: rating, scale: {{min: 1, max: 7}}, cross: [bounces], repeats: {}, timeout_ms: 150, cues: {}}}
)",
                       sounds, repeats, cues);
}

TEST_F(Sounds, BeginWhenTheJournalSays)
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
        EXPECT_EQ(s.sound, "beep");
        EXPECT_EQ(s.at, "a");
        EXPECT_EQ(s.event_s, t.shown.at(0).onset_s);
        EXPECT_NEAR(s.duration_s, 0.04, 1e-4);
        errors_ms.push_back(*study::error_ms(s));
    }
    std::sort(errors_ms.begin(), errors_ms.end());
    fmt::print("60 cues at stimuli: {:.2f} ms (median) from the picture, {:.2f} to {:.2f}\n", errors_ms[30],
               errors_ms.front(), errors_ms.back());
    EXPECT_LT(std::abs(errors_ms[30]), 20) << "one refresh of 50 Hz: the picture's own time is known no better";
    auto const started = run.entries<study::SessionStarted>();
    std::map<std::string, std::string> about(started[0].about.begin(), started[0].about.end());
    for (char const* key : {"audio_device", "audio_host", "audio_rate_hz", "audio_latency_ms"})
        EXPECT_FALSE(about[key].empty()) << key;
    EXPECT_EQ(about["audio_onset_method"], "dac_time");

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

    run_well("study rebuild data --script x.yaml", folder.path());
    std::string const table = file_text(run.folder() / "sub-P001_ses-01_task-seen_acq-sounds_events.tsv");
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 61);
    run_well("study report data --script x.yaml --out r.html", folder.path());
    EXPECT_NE(file_text(folder / "r.html").find(">Sounds<"), std::string::npos);
}

TEST_F(Sounds, OffsetsAndFilesAreKept)
{
    SilentSpeaker device(speaker.path());
    if (!device.problem().empty()) GTEST_SKIP() << "SKIPPED: " << device.problem();
    device.record(folder / "kept.raw"); // a null sink that nobody records asks for nothing once it ran dry
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
            EXPECT_LT(std::abs(*study::error_ms(t.sounds[i])), 200) << i; // a busy machine shows pictures late
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
