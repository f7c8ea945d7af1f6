#pragma once
// Sessions on a calibrated display with gaze.

#include "tests/viewer_trials/running_session.h"

namespace viewer::test {

/// A model of the whole screen under the X server of OnScreen, written by the command.
inline std::string calibrated(TemporaryFolder const& folder)
{
    std::string readings = "channel,value,cd_m2\n";
    for (int i = 0; i <= 8; ++i)
        for (auto const& [name, peak] : {std::pair{"red", 21.0}, {"green", 71.0}, {"blue", 8.0}})
            readings += fmt::format("{},{},{}\n", name, i / 8.0, 0.3 + peak * std::pow(i / 8.0, 2.2));
    std::ofstream(folder / "readings.csv") << readings;
    return run_well(
               "study calibrate --luminance readings.csv --screen 1000x700 --width-cm 30 --height-cm 21 "
               "--distance-cm 57.3 --ipd-mm 63 --instrument spotmeter --room dark --monitor Xvfb --out model.yaml",
               folder.path())
        .out;
}

/// Gaze in the middle of a window of 240 x 180 px, 250 times per second; away for the last 300 ms of `length_s`.
inline void write_gaze(TemporaryFolder const& folder, double length_s)
{
    std::ofstream out(folder / "gaze.csv");
    out << "t_s,x_px,y_px,pupil_mm,valid\n";
    for (int i = 0; i < int(250 * length_s); ++i) {
        bool const away = i / 250.0 > length_s - 0.3;
        out << fmt::format("{:.3f},{},{},3.1,{}\n", i / 250.0, away ? 5000 : 118 + i % 5, 90, int(i % 100 != 7));
    }
}

inline std::string measured_script(std::string const& trials, std::string const& markers,
                                   std::string const& sequence)
{
    return fmt::format(R"(schema: study/1
id: measured
seed: 4
participants: {{count: 2}}
timing: {{vsync: record, expected_hz: 50, calibrate: {{frames: 50}}, max_dropped_frames: 1000, sync_patch: {{px: 20}},
  display_lag_ms: 11.2, display_lag_uncertainty_ms: 0.4}}
factors: {{bounces: [0, 2]}}
defaults:
  settings: {{method: slhb, scene: cornell, paths: 1, scale: 1, size: 1.5 deg, mean_luminance: 10 cd/m2}}
  iti_ms: 20
  gaze: {{start: {{within_deg: 2, for_ms: 60}}, hold: {{within_deg: 3, grace_ms: 60}}, follow: {{radius_deg: 1}}}}
sequence: {}
record: {{markers: {}}}
blocks:
  seen: {{task: rating, scale: {{min: 1, max: 7}}, cross: [bounces], {}}}
)",
                       sequence, markers, trials);
}

/// Taps that come within a millisecond would be one.
inline void tap_slowly(XWindow& window, std::string const& key, int times = 1)
{
    for (; times > 0; --times) {
        window.tap(key);
        sleep_ms(40);
    }
}

inline std::filesystem::path peer_python()
{
    return std::filesystem::path(LIGHTWELL_SOURCE_DIR) / "build/python/bin/python";
}
/// The library that pylsl brings; empty = it is not installed.
inline std::string peer_lsl()
{
    for (auto const& entry :
         std::filesystem::exists(peer_python().parent_path().parent_path() / "lib")
             ? std::filesystem::directory_iterator(peer_python().parent_path().parent_path() / "lib")
             : std::filesystem::directory_iterator())
        if (auto const file = entry.path() / "site-packages/pylsl/lib/liblsl.so.2"; std::filesystem::exists(file))
            return file.string();
    return {};
}

} // namespace viewer::test
