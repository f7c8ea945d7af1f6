#pragma once
// Sessions with cues that are heard by a sound device that plays nowhere.

#include "tests/support/xvfb.h"
#include "tests/viewer_trials/measured_session.h"

#include <algorithm>

namespace viewer::test {

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
    /// Records what it plays until the end, as record_sound.py says.
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

inline std::string script_with(std::string const& cues, int repeats, std::string const& sounds)
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

} // namespace viewer::test
