// A session in a headset of a real runtime: stimuli one after the other, answers by controllers.

#include "study/journal/journal_file.h"
#include "tests/viewer_trials/running_session.h"
#include "tests/viewer_xr/monado.h"
#include "tests/viewer_xr/remote_driver.h"

namespace viewer::test {
namespace {

constexpr char const* kScriptText = R"(schema: study/1
id: worn
seed: 4
participants: {count: 2}
timing: {vsync: record, on_bad_trial: keep, calibrate: {frames: 50}}
factors: {bounces: [0, 2]}
defaults: {settings: {method: slhb, scene: cornell, paths: 1, view: openxr, scale: 0.5}, iti_ms: 100, isi_ms: 200, stimulus_ms: 500}
devices: {first: [xr:left/select], second: [xr:right/select]}
sequence: [better]
record: {markers: [udp]}
blocks:
  better: {task: pair, presentation: sequential, prompt: better, pairs: {factor: bounces}, repeats: 2}
)";

TEST_F(Monado, SessionInAHeadset)
{
    gi::test::Xvfb const server(700, 500);
    if (!server.problem().empty()) GTEST_SKIP() << "SKIPPED: " << server.problem();
    int const port = free_port();
    start_service({"--remote", std::to_string(port)});
    RemoteDriver remote(port);
    remote.set_head({{0, 0, 0, 1}, {0, 1.7f, 0}});
    auto const press = [&](std::size_t hand, bool pressed) {
        for (std::size_t h = 0; h < 2; ++h)
            remote.set_hand(h, {{0, 0, 0, 1}, {h == 0 ? -0.3f : 0.3f, 1.2f, -0.4f}}, {0, 0}, pressed && h == hand);
        remote.send_all();
    };
    press(0, false);
    std::ofstream(folder / "x.yaml") << kScriptText;
    MarkerListener const markers;
    std::vector<std::string> call{kScript, "client", "--dir", runtime_folder(), "--", LIGHTWELL_PROGRAM};
    for (std::string const& a :
         words(fmt::format("study run {} --participant 1 --dir {} --size 320x240 --font 12 --threads 1 --hmd "
                           "--marker-port {}",
                           (folder / "x.yaml").string(), (folder / "data").string(), markers.port())))
        call.push_back(a);
    Child session(call, folder.path(), "session");
    for (int trial = 0; trial < 2; ++trial) {
        for (int interval = 0; interval < 2; ++interval)
            ASSERT_TRUE(markers.wait_for("stimulus").is_object()) << session.out() << session.err();
        sleep_ms(300);
        press(std::size_t(trial), true);
        EXPECT_TRUE(markers.wait_for("answer").is_object());
        press(0, false);
    }
    EXPECT_EQ(session.wait(Seconds(90)), 0) << session.out() << session.err();
    auto const file = folder / "data/sub-P001/ses-01/beh/journal.jsonl";
    std::vector<study::TrialDone> trials;
    for (study::JournalEntry const& e : study::read_journal(file).record.entries)
        if (auto const* const t = std::get_if<study::TrialDone>(&e)) trials.push_back(*t);
    ASSERT_EQ(trials.size(), 2u);
    EXPECT_EQ(trials[0].response, "first");
    EXPECT_EQ(trials[0].device, "xr:left/select");
    EXPECT_EQ(trials[1].response, "second");
    for (study::TrialDone const& t : trials)
        for (study::StimulusShown const& s : t.shown) {
            EXPECT_EQ(s.onset_method, "openxr_predicted") << "a prediction is never called measured";
            EXPECT_GT(s.onset_uncertainty_ms, 0);
        }
}

/// A camera that moves by itself, so that pictures are old whatever the head does.
TEST_F(Monado, ShownFramesInAHeadset)
{
    gi::test::Xvfb const server(700, 500);
    if (!server.problem().empty()) GTEST_SKIP() << "SKIPPED: " << server.problem();
    start_service();
    std::string text = kScriptText;
    for (auto const& [from, to] :
         {std::pair<std::string, std::string>{"{bounces: [0, 2]}", "{frames: [exact, shown]}"},
          {"factor: bounces", "factor: frames"},
          {"scale: 0.5", "camera: \"path:orbit\""},
          {"stimulus_ms: 500", "stimulus_ms: 1000, timeout_ms: 1100"},
          {"repeats: 2", "repeats: 1"}})
        text.replace(text.find(from), from.size(), to);
    std::ofstream(folder / "x.yaml") << text;
    std::vector<std::string> call{kScript, "client", "--dir", runtime_folder(), "--", LIGHTWELL_PROGRAM};
    for (std::string const& a :
         words(fmt::format("study run {} --participant 1 --dir {} --size 320x240 --font 12 --hmd",
                           (folder / "x.yaml").string(), (folder / "data").string())))
        call.push_back(a);
    Child session(call, folder.path(), "session");
    EXPECT_EQ(session.wait(Seconds(120)), 0) << session.out() << session.err();
    int shown = 0;
    for (study::JournalEntry const& e :
         study::read_journal(folder / "data/sub-P001/ses-01/beh/journal.jsonl").record.entries)
        if (auto const* const t = std::get_if<study::TrialDone>(&e))
            for (study::StimulusShown const& s : t->shown) {
                if (s.frames_kind.empty()) continue;
                ++shown;
                EXPECT_GT(s.frames_drawn.value_or(0), s.frames_shown / 2);
                EXPECT_GT(s.light_age_ms.value_or(0), 0);
            }
    EXPECT_EQ(shown, 1) << session.err();
}

/// The session of kScriptText, without answers. @return its process
Child gaze_session(std::filesystem::path const& folder, std::filesystem::path const& runtime,
                   std::vector<std::string> const& environment, std::string const& more = "--hmd")
{
    std::string text = kScriptText;
    text.replace(text.find("stimulus_ms: 500"), 16, "stimulus_ms: 500, timeout_ms: 600");
    std::ofstream(folder / "x.yaml") << text;
    std::vector<std::string> call{kScript, "client", "--dir", runtime, "--", LIGHTWELL_PROGRAM};
    for (std::string const& a : words(fmt::format(
             "study run {} --participant 1 --dir {} --size 320x240 --font 12 --threads 1 --gaze openxr {}",
             (folder / "x.yaml").string(), (folder / "data").string(), more)))
        call.push_back(a);
    return Child(call, folder, "session", environment);
}

TEST_F(Monado, GazeOfTheHeadsetIsRecorded)
{
    gi::test::Xvfb const server(700, 500);
    if (!server.problem().empty()) GTEST_SKIP() << "SKIPPED: " << server.problem();
    start_service();
    Child session =
        gaze_session(folder.path(), runtime_folder(),
                     {"XR_API_LAYER_PATH=" GAZE_LAYER, "XR_ENABLE_API_LAYERS=XR_APILAYER_LIGHTWELL_test_gaze"});
    EXPECT_EQ(session.wait(Seconds(90)), 0) << session.out() << session.err();
    auto const at = folder / "data/sub-P001/ses-01/beh";
    auto const rows = read_log(at / "sub-P001_ses-01_part-01_gaze.csv");
    // 10 degrees to the right and 5 up, in a window of 320 px that is 0.8 wide at a distance of 1.
    double const scale = 320 / 0.8, degree = 0.017453292519943295;
    int valid = 0, shown = 0;
    double last_s = 0;
    for (auto const& row : rows) {
        EXPECT_GT(std::stod(row.at("t_s")), last_s);
        last_s = std::stod(row.at("t_s"));
        shown += row.at("shown") != "-";
        if (row.at("valid") != "1") continue;
        ++valid;
        EXPECT_NEAR(std::stod(row.at("x_px")), 160 + scale * std::tan(10 * degree), 0.5);
        EXPECT_NEAR(std::stod(row.at("y_px")), 120 - scale * std::tan(5 * degree) / std::cos(10 * degree), 0.5);
    }
    fmt::print("{} samples of gaze by OpenXR, {} valid, {} while a stimulus was shown\n", rows.size(), valid,
               shown);
    EXPECT_GT(valid, 20);
    EXPECT_LT(valid, int(rows.size())) << "blinks";
    EXPECT_GT(shown, 20);
    study::SessionRecord const record = study::read_journal(at / "journal.jsonl").record;
    for (study::JournalEntry const& e : record.entries)
        if (auto const* const t = std::get_if<study::TrialDone>(&e)) {
            EXPECT_GT(t->gaze_samples.value_or(0), 5);
        }
    auto const about = std::get<study::SessionStarted>(record.entries.at(0)).about;
    std::map<std::string, std::string> const facts(about.begin(), about.end());
    EXPECT_EQ(facts.at("gaze_source"), "openxr: XR_EXT_eye_gaze_interaction");
    EXPECT_EQ(facts.at("gaze_px_per_tangent"), "400.000");
    EXPECT_TRUE(std::filesystem::exists(at / "sub-P001_ses-01_task-session_recording-eye1_physio.tsv.gz"));
}

TEST_F(Monado, GazeThatTheHeadsetDoesNotHaveIsRefused)
{
    gi::test::Xvfb const server(700, 500);
    if (!server.problem().empty()) GTEST_SKIP() << "SKIPPED: " << server.problem();
    start_service();
    Child session = gaze_session(folder.path(), runtime_folder(), {});
    EXPECT_EQ(session.wait(Seconds(60)), 2) << session.out();
    EXPECT_TRUE(session.err().find("the headset does not track eyes") != std::string::npos ||
                session.err().find("XR_EXT_eye_gaze_interaction") != std::string::npos)
        << session.err();
    EXPECT_FALSE(std::filesystem::exists(folder / "data"));
    Child in_window = gaze_session(folder.path(), runtime_folder(), {}, "");
    EXPECT_EQ(in_window.wait(Seconds(60)), 2) << in_window.out();
    EXPECT_NE(in_window.err().find("--hmd"), std::string::npos) << in_window.err();
}

} // namespace
} // namespace viewer::test
