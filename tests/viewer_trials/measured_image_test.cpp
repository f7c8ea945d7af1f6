// Sessions on a calibrated display: luminance and size of what is shown, gaze that decides,
// markers that other programs read.

#include "tests/viewer_trials/measured_session.h"

#include "study/display/model_file.h"

#include <algorithm>

namespace viewer::test {
namespace {

class Measured : public OnScreen {
protected:
    TemporaryFolder folder;
};

#define NEED_KEYS(run)                                                                                            \
    if (!(run).window().key_problem().empty()) GTEST_SKIP() << "SKIPPED: " << (run).window().key_problem()

/// Stimuli are answered as they come. @return number of stimuli
int answer(RunningSession& run, int most)
{
    int shown = 0;
    for (; shown < most; ++shown) {
        if (!run.markers.wait_for("stimulus", std::chrono::seconds(shown < 2 ? 60 : 4)).is_object()) break;
        sleep_ms(160); // later than an anticipation
        run.window().tap("5");
    }
    return shown;
}

TEST_F(Measured, StimuliHaveTheirLuminanceSizeAndGaze)
{
    EXPECT_NE(calibrated(folder).find("pixels per degree"), std::string::npos);
    write_gaze(folder, 2.5);
    RunningSession run(folder, measured_script("repeats: 3", "[udp]", "[seen]"),
                       "--display-model model.yaml --gaze gaze.csv");
    NEED_KEYS(run);
    answer(run, 30);
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    auto const trials = run.entries<study::TrialDone>();
    ASSERT_GE(trials.size(), 6u);
    int valid = 0, left = 0;
    for (study::TrialDone const& t : trials) {
        valid += t.is_valid;
        left += t.reason == "gaze_left";
        ASSERT_TRUE(t.gaze_samples && t.gaze_valid && t.gaze_fixating);
        EXPECT_LE(*t.gaze_fixating, *t.gaze_valid);
        if (t.shown.empty()) continue;
        study::StimulusShown const& s = t.shown[0];
        ASSERT_TRUE(s.mean_cd_m2 && s.width_deg && s.clipped_pixels);
        EXPECT_NEAR(*s.width_deg, 1.5, 0.02);
        EXPECT_NEAR(*s.mean_cd_m2, 10, 0.1);
        ASSERT_TRUE(s.left_px && s.top_px && s.width_px && s.height_px);
        EXPECT_NEAR(*s.left_px + 0.5 * *s.width_px, 120, 1) << "in the middle";
        EXPECT_NEAR(*s.width_px, 1.5 * 33.3, 2);
    }
    fmt::print("{} trials, {} valid, {} ended because gaze left\n", trials.size(), valid, left);
    EXPECT_EQ(valid, 6);
    auto const started = run.entries<study::SessionStarted>();
    std::map<std::string, std::string> about(started[0].about.begin(), started[0].about.end());
    for (char const* key : {"processor", "os", "monitor", "display_model_sha256", "pixels_per_degree",
                            "white_cd_m2", "gaze_source", "gaze_table", "display_lag_uncertainty_ms", "opengl"})
        EXPECT_FALSE(about[key].empty()) << key;
    EXPECT_EQ(about["display_model_sha256"], study::load_display_model(folder / "model.yaml").sha256);
    EXPECT_TRUE(
        std::filesystem::exists(run.folder() / "sub-P001_ses-01_task-session_recording-eye1_physio.tsv.gz"));
    std::string const report = (folder / "r.html").string();
    run_well("study report data --out r.html", folder.path());
    EXPECT_NE(file_text(report).find("pixels_per_degree"), std::string::npos);
    EXPECT_NE(file_text(report).find("no fixation"), std::string::npos);
    EXPECT_NE(file_text(report).find("What people looked at"), std::string::npos);

    // Gaze is below the picture, within the accuracy of the eye tracker.
    run_well("study analyze data --gaze --objects --accuracy 1 --out looked", folder.path());
    auto const looked = nlohmann::json::parse(file_text((folder / "looked/gaze.json").string()));
    EXPECT_TRUE(looked["tables"]["dwell_left_out"].empty()) << looked["tables"]["dwell_left_out"];
    double on_objects = 0, beside = 0, all = 0;
    for (auto const& row : looked["tables"]["dwell"]) {
        if (row["kind"] != "material") all += row["seconds"].get<double>();
        if (row["kind"] == "object") on_objects += row["seconds"].get<double>();
        if (row["name"] == "beside the picture") beside += row["seconds"].get<double>();
    }
    double fixated = 0;
    for (auto const& row : looked["tables"]["gaze_views"])
        if (row["counted"].get<bool>() && row["usable"].get<bool>()) fixated += 1e-3 * row["dwell_ms"].get<double>();
    fmt::print("fixations of {:.3f} s: {:.3f} s on objects, {:.3f} s beside the picture\n", fixated, on_objects,
               beside);
    EXPECT_GT(on_objects, 0.05 * fixated);
    EXPECT_NEAR(all, fixated, 1e-3);
    EXPECT_TRUE(std::filesystem::exists(folder / "looked/surfacescornell.ply"));
}

TEST_F(Measured, AModelOfAnotherScreenIsRefused)
{
    calibrated(folder);
    std::string const script = measured_script("repeats: 1", "[udp]", "[seen]");
    std::string model = file_text(folder / "model.yaml");
    model.replace(model.find("[1000, 700]"), 11, "[2000, 1400]");
    std::ofstream(folder / "other.yaml") << model;
    write_gaze(folder, 1);
    Outcome const o = RunningSession(folder, script, "--display-model other.yaml --gaze gaze.csv").wait();
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("the display model is of 2000 x 1400 px"), std::string::npos) << o.err;
    Outcome const without = RunningSession(folder, script, "--gaze gaze.csv").wait();
    EXPECT_EQ(without.code, 2);
    EXPECT_NE(without.err.find("--display-model"), std::string::npos) << without.err;
    Outcome const blind = RunningSession(folder, script, "--display-model model.yaml").wait();
    EXPECT_EQ(blind.code, 2);
    EXPECT_NE(blind.err.find("nothing measures it"), std::string::npos) << blind.err;
}

/// The test's reader is pylsl, on the real library.
TEST_F(Measured, MarkersAreReadByOthersWithTheirTimes)
{
    if (peer_lsl().empty()) GTEST_SKIP() << "SKIPPED: pylsl is not installed (scripts/setup --tests installs it)";
    setenv("PYLSL_LIB", peer_lsl().c_str(), 1);
    calibrated(folder);
    write_gaze(folder, 30);
    std::string const here = LIGHTWELL_SOURCE_DIR "/tests/viewer_trials";
    std::string const reader = fmt::format(
        "timeout 120 '{}' '{}/read_markers.py' '{}/read' '{}/stop' > /dev/null 2> '{}/read.err' &",
        peer_python().string(), here, folder.path().string(), folder.path().string(), folder.path().string());
    ASSERT_EQ(std::system(reader.c_str()), 0);
    RunningSession run(folder, measured_script("repeats: 6", "[udp, lsl]", "[{instructions: ready}, seen]"),
                       "--display-model model.yaml --gaze gaze.csv");
    NEED_KEYS(run);
    ASSERT_TRUE(run.wait_until_at("instructions")) << run.program().errors();
    EXPECT_TRUE(is_soon([&] { return file_text(folder / "read").find("\n") != std::string::npos; }))
        << file_text(folder / "read.err");
    run.window().tap("space");
    answer(run, 40);
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    sleep_ms(500);
    std::ofstream(folder / "stop") << "now";
    std::istringstream lines(file_text(folder / "read"));
    std::string line;
    std::getline(lines, line);
    Json const about = Json::parse(line);
    EXPECT_EQ(about.at("type"), "Markers");
    EXPECT_EQ(about.at("participant"), "P001");
    std::map<double, Json> stimuli;
    std::vector<double> offsets_ms, delays_ms;
    int answers = 0, ends = 0;
    while (std::getline(lines, line)) {
        Json const one = Json::parse(line), event = one.at("event");
        offsets_ms.push_back(1e3 * (one.at("time").get<double>() - event.at("time_s").get<double>()));
        std::string const what = event.at("marker");
        answers += what == "answer";
        ends += what == "trial_end";
        if (what != "stimulus") continue;
        stimuli[event.at("time_s").get<double>()] = event;
        delays_ms.push_back(1e3 * (one.at("now").get<double>() - one.at("time").get<double>()));
    }
    auto const trials = run.entries<study::TrialDone>();
    ASSERT_FALSE(stimuli.empty());
    std::size_t shown = 0, answered = 0;
    for (study::TrialDone const& t : trials) {
        answered += !t.response.empty();
        for (study::StimulusShown const& s : t.shown) {
            ++shown;
            auto const found = stimuli.lower_bound(s.onset_s - 1e-6);
            ASSERT_NE(found, stimuli.end());
            EXPECT_NEAR(found->first, s.onset_s, 1e-6) << "the same onset as in the journal";
            EXPECT_EQ(found->second.at("step"), t.step);
            EXPECT_TRUE(found->second.at("stimuli").contains("a"));
        }
    }
    EXPECT_EQ(stimuli.size(), shown);
    EXPECT_EQ(std::size_t(answers), answered);
    EXPECT_EQ(std::size_t(ends), trials.size());
    std::sort(offsets_ms.begin(), offsets_ms.end());
    std::sort(delays_ms.begin(), delays_ms.end());
    fmt::print("{} markers by pylsl: time minus journal {:.4f} to {:.4f} ms, correction {:.4f} ms, read {:.2f} ms "
               "after the "
               "onset (median, most {:.2f})\n",
               offsets_ms.size(), offsets_ms.front(), offsets_ms.back(),
               1e3 * about.at("correction_s").get<double>(), delays_ms[delays_ms.size() / 2], delays_ms.back());
    EXPECT_LT(offsets_ms.back() - offsets_ms.front(), 0.001) << "no jitter: the times are the journal's";
    EXPECT_LT(std::max(std::abs(offsets_ms.front()), std::abs(offsets_ms.back())), 0.1);
    unsetenv("PYLSL_LIB");
}

TEST_F(Measured, GazeComesFromAStream)
{
    if (peer_lsl().empty()) GTEST_SKIP() << "SKIPPED: pylsl is not installed (scripts/setup --tests installs it)";
    setenv("PYLSL_LIB", peer_lsl().c_str(), 1);
    calibrated(folder);
    std::string const sender =
        fmt::format("timeout 60 '{}' '{}/tests/viewer_trials/send_gaze.py' > /dev/null 2>&1 & echo $! > '{}/pid'",
                    peer_python().string(), LIGHTWELL_SOURCE_DIR, folder.path().string());
    ASSERT_EQ(std::system(sender.c_str()), 0);
    std::string text = measured_script("repeats: 2", "[udp]", "[seen]");
    std::string const wide = "within_deg: 2,"; // the window may be anywhere on the screen
    text.replace(text.find(wide), wide.size(), "within_deg: 40,");
    text.replace(text.find("within_deg: 3,"), wide.size(), "within_deg: 40,");
    RunningSession run(folder, text, "--display-model model.yaml --gaze lsl");
    NEED_KEYS(run);
    answer(run, 20);
    Outcome const o = run.wait();
    kill(pid_t(std::stoi(file_text(folder / "pid"))), SIGTERM); // timeout ends its child
    unsetenv("PYLSL_LIB");
    EXPECT_EQ(o.code, 0) << o.err;
    auto const trials = run.entries<study::TrialDone>();
    ASSERT_GE(trials.size(), 4u);
    int samples = 0, valid = 0, dropped = 0;
    for (study::TrialDone const& t : trials) {
        samples += t.gaze_samples.value_or(0);
        valid += t.gaze_valid.value_or(0);
        dropped += t.gaze_dropped.value_or(0);
    }
    fmt::print("{} samples of gaze by LSL, {} valid, {} missing\n", samples, valid, dropped);
    EXPECT_GT(samples, 50);
    EXPECT_LT(valid, samples) << "one in fifty is not valid";
    EXPECT_EQ(dropped, 0);
}

TEST_F(Measured, AStreamThatIsNotThereIsRefused)
{
    if (peer_lsl().empty()) GTEST_SKIP() << "SKIPPED: pylsl is not installed (scripts/setup --tests installs it)";
    setenv("PYLSL_LIB", peer_lsl().c_str(), 1);
    calibrated(folder);
    Outcome const o = RunningSession(folder, measured_script("repeats: 1", "[udp]", "[seen]"),
                                     "--display-model model.yaml --gaze lsl:Nobody")
                          .wait();
    unsetenv("PYLSL_LIB");
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("no stream of gaze named 'Nobody'"), std::string::npos) << o.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "data"));
}

/// Keys as of an observer who sees a gamma of 2.2.
TEST_F(Measured, DisplaysAreCalibratedInTheWindow)
{
    Program program(words("study calibrate --size 400x300 --card --measure white --levels 5 --distance-cm 60 "
                          "--readings-out r.csv --out m.yaml"),
                    folder.path());
    XWindow window("Lightwell: calibrate");
    if (!window.key_problem().empty()) GTEST_SKIP() << "SKIPPED: " << window.key_problem();
    window.focus();
    auto const centre = [&] { return int(window.picture({198, 140}, {1, 1}).at(0)); };
    ASSERT_TRUE(is_soon([&] { return centre() == 190; })) << "the card";
    tap_slowly(window, "Prior", 3); // 320 + 48 px
    tap_slowly(window, "Right");
    sleep_ms(150);
    window.tap("Return");
    for (int const value : {0, 64, 128, 191, 255}) {
        ASSERT_TRUE(is_soon([&] { return std::abs(centre() - value) <= 1; })) << value << " " << centre();
        sleep_ms(100);
        for (char const c : fmt::format("{:.0f}", 200 * std::pow(value / 255.0, 2.2) + 1))
            tap_slowly(window, std::string(1, c));
        sleep_ms(150);
        window.tap("Return");
    }
    Outcome const o = program.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    study::DisplayModel const m = study::load_display_model(folder / "m.yaml");
    ASSERT_TRUE(m.screen && m.luminance);
    EXPECT_NEAR(m.screen->width_cm, 1000 / (369 / 8.56), 0.1);
    EXPECT_NEAR(m.luminance->white(), 201, 5);
    EXPECT_NEAR(m.luminance->channels[1].gamma, 2.2, 0.1);
    std::string const readings = file_text(folder / "r.csv");
    EXPECT_EQ(std::count(readings.begin(), readings.end(), '\n'), 6) << readings;
}

TEST_F(Measured, GammaIsMatchedByEye)
{
    Program program(
        words("study calibrate --size 400x300 --gamma-by-eye white --white 120 --black 0.2 --out m.yaml"),
        folder.path());
    XWindow window("Lightwell: calibrate");
    if (!window.key_problem().empty()) GTEST_SKIP() << "SKIPPED: " << window.key_problem();
    window.focus();
    for (double const share : {0.25, 0.5, 0.75}) {
        int const wanted = int(std::lround(255 * std::pow(share, 1 / 2.2)));
        ASSERT_TRUE(is_soon([&] { return window.picture({240, 150}, {1, 1}).at(0) == 128; }));
        auto const lines = window.picture({150, 100}, {1, 80});
        int bright = 0;
        for (std::size_t i = 0; i < lines.size(); i += 3) bright += lines[i] == 255;
        EXPECT_NEAR(bright, 80 * share, 1) << "lines that are bright";
        int value = 128;
        for (; value + 16 <= wanted; value += 16) tap_slowly(window, "Prior");
        for (; value < wanted; ++value) tap_slowly(window, "Up");
        ASSERT_TRUE(is_soon([&] { return window.picture({240, 150}, {1, 1}).at(0) == wanted; }));
        window.tap("Return");
    }
    Outcome const o = program.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    study::DisplayModel const m = study::load_display_model(folder / "m.yaml");
    EXPECT_NEAR(m.luminance->channels[1].gamma, 2.2, 0.02);
    EXPECT_EQ(m.luminance->method, study::LuminanceMethod::by_eye);
}

TEST_F(Measured, EscapeLeavesNoModel)
{
    Program program(words("study calibrate --size 400x300 --gamma-by-eye white --out m.yaml"), folder.path());
    XWindow window("Lightwell: calibrate");
    if (!window.key_problem().empty()) GTEST_SKIP() << "SKIPPED: " << window.key_problem();
    window.focus();
    sleep_ms(300);
    window.tap("Escape");
    EXPECT_EQ(program.wait().code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "m.yaml"));
}

} // namespace
} // namespace viewer::test
