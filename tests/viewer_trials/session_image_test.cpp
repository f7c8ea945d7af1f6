// Sessions in a real window under an X server without a monitor: keys by XTEST, onsets by markers.

#include "tests/viewer_trials/tiny_session.h"

#include <algorithm>
#include <csignal>

namespace viewer::test {
namespace {

class Sessions : public OnScreen {
protected:
    TemporaryFolder folder;
};

TEST_F(Sessions, RequiredVsyncIsRefusedWithTheReason)
{
    RunningSession run(folder, tiny_script("vsync: required", "[better]", kPair));
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_NE(o.err.find("do not wait for the display"), std::string::npos) << o.err;
    EXPECT_FALSE(std::filesystem::exists(run.folder() / "journal.jsonl") &&
                 !run.entries<study::TrialDone>().empty());
}

/// No answer is earlier than its key, or later than the next stimulus that it brings, whatever else the machine does.
TEST_F(Sessions, ReactionTimesAreThoseOfTheKeys)
{
    std::string pair = kPair;
    pair.replace(pair.find("repeats: 10"), 11, "repeats: 3");
    RunningSession run(folder, tiny_script("vsync: record, on_bad_trial: keep", "[better]", pair));
    NEED_KEYS(run);
    std::vector<double> before, after;
    for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(run.markers.wait_for("stimulus").is_object()) << run.program().errors();
        before.push_back(steady_s());
        run.window().tap(i % 2 == 0 ? "Left" : "Right");
        ASSERT_TRUE(run.markers.wait_for("stimulus_end").is_object());
        after.push_back(steady_s());
    }
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    auto const trials = run.entries<study::TrialDone>();
    ASSERT_EQ(trials.size(), 3u);
    for (std::size_t i = 0; i < trials.size(); ++i) {
        study::TrialDone const& t = trials[i];
        ASSERT_TRUE(t.reaction_ms) << i;
        EXPECT_EQ(t.response, i % 2 == 0 ? "first" : "second");
        EXPECT_EQ(t.device, i % 2 == 0 ? "key:left" : "key:right");
        EXPECT_GT(t.response_uncertainty_ms, 0);
        double const at_s = t.shown.back().onset_s + 1e-3 * *t.reaction_ms,
                     within_s = 1e-3 * t.response_uncertainty_ms;
        EXPECT_GE(at_s + within_s, before[i]) << i;
        EXPECT_LE(at_s - within_s, after[i]) << i;
        for (study::StimulusShown const& s : t.shown) {
            EXPECT_EQ(s.onset_method, "swap_finish");
            EXPECT_GT(s.onset_uncertainty_ms, 0);
            EXPECT_GE(s.frames_shown, 1);
            EXPECT_EQ(s.settings_sha256.size(), 64u);
        }
    }
    auto const calibration = run.entries<study::CalibrationDone>();
    ASSERT_EQ(calibration.size(), 1u);
    EXPECT_FALSE(calibration[0].passed);
    std::string const frames = file_text(run.folder() / "sub-P001_ses-01_frames.csv");
    EXPECT_GT(std::count(frames.begin(), frames.end(), '\n'), 3);
}

TEST_F(Sessions, TheExperimenterSeesPausesNotesAndEndsIt)
{
    RunningSession run(
        folder, tiny_script("vsync: record, on_bad_trial: keep", "[{instructions: \"# Hello\"}, better]", kPair));
    NEED_KEYS(run);
    ASSERT_TRUE(run.wait_until_at("instructions")) << run.program().errors();
    run.session("note", "came late");
    run.session("pause");
    run.window().tap("space");
    ASSERT_TRUE(run.wait_until_at("paused"));
    run.session("go_on");
    ASSERT_TRUE(run.markers.wait_for("stimulus").is_object());
    Json const status = run.session("status");
    EXPECT_EQ(status.at("trials_planned"), 10);
    EXPECT_EQ(status.at("trials_done"), 0);
    run.window().tap("Left");
    ASSERT_TRUE(run.markers.wait_for("stimulus").is_object());
    run.session("skip");
    ASSERT_TRUE(run.markers.wait_for("stimulus").is_object());
    run.session("abort", "enough");
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 1) << o.err;
    auto const trials = run.entries<study::TrialDone>();
    ASSERT_EQ(trials.size(), 2u);
    EXPECT_TRUE(trials[0].response == "first");
    EXPECT_FALSE(trials[1].is_valid);
    EXPECT_EQ(trials[1].reason, "skipped");
    std::string notes;
    for (study::NoteTaken const& n : run.entries<study::NoteTaken>()) notes += n.kind + " " + n.text + ";";
    EXPECT_NE(notes.find("note came late;pause ;"), std::string::npos) << notes;
    EXPECT_NE(notes.find("abort enough"), std::string::npos) << notes;
}

TEST_F(Sessions, OnlyTheParticipantAgrees)
{
    std::string text = tiny_script("vsync: record, on_bad_trial: keep", "[better]", kPair);
    std::string const count = "{count: 2}";
    text.replace(text.find(count), count.size(), "{count: 2, consent: \"# May we?\"}");
    RunningSession run(folder, text);
    NEED_KEYS(run);
    ASSERT_TRUE(run.wait_until_at("consent")) << run.program().errors();
    run.session("skip");
    sleep_ms(300);
    EXPECT_EQ(run.session("status").at("doing"), "consent") << "it cannot be skipped";
    run.window().tap("y");
    EXPECT_TRUE(run.markers.wait_for("stimulus").is_object());
    run.session("abort");
    run.wait();
    EXPECT_EQ(run.reason(), "aborted by the experimenter");
}

TEST_F(Sessions, AnInterruptIsTheReason)
{
    RunningSession run(folder, tiny_script("vsync: record, on_bad_trial: keep", "[better]", kPair));
    NEED_KEYS(run);
    ASSERT_TRUE(run.markers.wait_for("stimulus").is_object()) << run.program().errors();
    run.program().send(SIGINT);
    EXPECT_EQ(run.wait().code, 1);
    EXPECT_EQ(run.reason(), "interrupted (SIGINT, SIGTERM or SIGHUP)");
}

TEST_F(Sessions, TrialsThatAreDoneCountInABreakToo)
{
    RunningSession run(folder,
                       tiny_script("vsync: record, on_bad_trial: keep", "[better, {break: {min_s: 0}}]",
                              "  better: {task: pair, prompt: better, pairs: {factor: bounces}, repeats: 1}\n"));
    NEED_KEYS(run);
    ASSERT_TRUE(run.markers.wait_for("stimulus").is_object()) << run.program().errors();
    run.window().tap("Left");
    ASSERT_TRUE(run.wait_until_at("break"));
    EXPECT_EQ(run.session("status").at("trials_done"), 1);
    run.window().tap("space");
    EXPECT_EQ(run.wait().code, 0);
}

TEST_F(Sessions, EscapeTwiceEndsItAndItGoesOnInTheSameOrder)
{
    std::string const text =
        tiny_script("vsync: record, on_bad_trial: keep", "[better, {questionnaire: sus_presence}]",
               "  better: {task: pair, prompt: better, pairs: {factor: bounces}, repeats: 3}\n");
    {
        RunningSession run(folder, text);
        NEED_KEYS(run);
        ASSERT_TRUE(run.markers.wait_for("stimulus").is_object()) << run.program().errors();
        run.window().tap("Left");
        ASSERT_TRUE(run.markers.wait_for("stimulus").is_object());
        run.window().tap("Escape");
        sleep_ms(100); // or else the server takes it for a key that is held
        run.window().tap("Escape");
        EXPECT_EQ(run.wait().code, 1);
        EXPECT_EQ(run.entries<study::TrialDone>().size(), 1u);
        EXPECT_EQ(run.reason(), "aborted by the participant");
    }
    EXPECT_EQ(RunningSession(folder, text).wait().code, 2) << "it is never overwritten";
    RunningSession run(folder, text, "--resume");
    for (int i = 0; i < 2; ++i) {
        ASSERT_TRUE(run.markers.wait_for("stimulus").is_object()) << run.program().errors();
        run.window().tap("Right");
    }
    ASSERT_TRUE(run.wait_until_at("questionnaire"));
    sleep_ms(200);
    for (int item = 0; item < 6; ++item) {
        run.window().tap(item == 2 ? "Tab" : "4");
        sleep_ms(150);
        if (item != 2) run.window().tap("space");
        sleep_ms(150);
    }
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    auto const trials = run.entries<study::TrialDone>();
    ASSERT_EQ(trials.size(), 3u);
    EXPECT_EQ(trials[2].step, trials[1].step + 1);
    auto const answers = run.entries<study::QuestionnaireDone>();
    ASSERT_EQ(answers.size(), 1u);
    ASSERT_EQ(answers[0].answers.size(), 6u);
    EXPECT_EQ(answers[0].answers[0], 4);
    EXPECT_FALSE(answers[0].answers[2]) << "no answer";
}

TEST_F(Sessions, PreparedStimuliAreShownAndRenderedOnlyOnce)
{
    std::string const text = tiny_script(
        "vsync: record, on_bad_trial: keep", "[better]",
        "  better: {task: pair, prompt: better, pairs: {factor: bounces}, repeats: 2, stimuli: prepared}\n");
    std::ofstream(folder / "x.yaml") << text;
    std::string const prepare = "study prepare x.yaml --size 240x180 --font 12 --out prepared";
    EXPECT_NE(run_well(prepare, folder.path()).out.find("2 stimuli, 2 rendered"), std::string::npos);
    EXPECT_NE(run_well(prepare, folder.path()).out.find("2 stimuli, 0 rendered, 2 existed already"),
              std::string::npos);
    RunningSession run(folder, text, "--prepared prepared");
    NEED_KEYS(run);
    for (int i = 0; i < 2; ++i) {
        ASSERT_TRUE(run.markers.wait_for("stimulus").is_object()) << run.program().errors();
        auto const is_background = [&](glm::ivec2 px) { return run.window().picture(px, {1, 1}).at(0) == 128; };
        if (i == 0) { // two pictures side by side
            EXPECT_TRUE(is_soon([&] { return !is_background({50, 50}) && !is_background({180, 50}); }));
        }
        run.window().tap("Left");
    }
    EXPECT_EQ(run.wait().code, 0);
    EXPECT_EQ(run.entries<study::TrialDone>().size(), 2u);
}

/// Two walls at a right angle, for one eye.
constexpr char const* kCorner = R"(name: corner
walls:
  - {name: front, lower_left_m: [-1, 0, -1], lower_right_m: [1, 0, -1], upper_left_m: [-1, 2, -1], window: front}
  - {name: right, lower_left_m: [1, 0, -1], lower_right_m: [1, 0, 1], upper_left_m: [1, 2, -1], window: right}
windows:
  - {name: front, size_px: [120, 120], position_px: [0, 0]}
  - {name: right, size_px: [120, 120], position_px: [140, 0]}
users:
  - {name: guest, head_position_m: [0, 1, 0]}
)";

TEST_F(Sessions, WallsShowOneStimulusAtATime)
{
    std::ofstream(folder / "corner.yaml") << kCorner;
    RunningSession run(folder,
                       tiny_script("vsync: record, on_bad_trial: keep", "[seen]",
                              "  seen: {task: rating, prompt: how, scale: {min: 1, max: 7}, cross: [bounces]}\n"),
                       "--display corner.yaml");
    NEED_KEYS(run);
    for (int i = 0; i < 2; ++i) {
        ASSERT_TRUE(run.markers.wait_for("stimulus").is_object()) << run.program().errors();
        XWindow const right("Lightwell: right");
        EXPECT_TRUE(is_soon([&] {
            return right.picture({60, 60}, {1, 1}).at(0) != 128;
        })) << "the other wall shows it too";
        run.window().tap("3");
    }
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    auto const trials = run.entries<study::TrialDone>();
    ASSERT_EQ(trials.size(), 2u);
    EXPECT_EQ(trials[0].value, 3);
    EXPECT_NE(trials[0].reason, "timeout");
    auto const about = run.entries<study::SessionStarted>().at(0).about;
    EXPECT_NE(
        std::find(about.begin(), about.end(), std::pair<std::string, std::string>("display", "walls: corner")),
        about.end());
}

TEST_F(Sessions, PairsSideBySideOnWallsAreRefused)
{
    std::ofstream(folder / "corner.yaml") << kCorner;
    RunningSession run(folder, tiny_script("vsync: record", "[better]", kPair), "--display corner.yaml");
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("presentation: sequential"), std::string::npos) << o.err;
}

TEST_F(Sessions, PreparedStimuliThatAreNotThereAreRefusedBeforeAnybodySitsDown)
{
    RunningSession run(folder, tiny_script("vsync: record", "[better]",
                                      "  better: {task: pair, prompt: better, pairs: {factor: bounces}, "
                                      "stimuli: prepared}\n"));
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("study prepare"), std::string::npos) << o.err;
}

TEST_F(Sessions, PreparedStimuliThatAreDamagedAreRefusedToo)
{
    std::string const text =
        tiny_script("vsync: record", "[better]",
               "  better: {task: pair, prompt: better, pairs: {factor: bounces}, stimuli: prepared}\n");
    std::ofstream(folder / "x.yaml") << text;
    run_well("study prepare x.yaml --size 240x180 --font 12 --out prepared", folder.path());
    for (auto const& entry : std::filesystem::directory_iterator(folder / "prepared"))
        std::filesystem::remove(entry.path() / "00000_0.exr");
    Outcome const o = RunningSession(folder, text, "--prepared prepared").wait();
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("is not whole (its 00000_0.exr is missing or damaged)"), std::string::npos) << o.err;
}

TEST_F(Sessions, ScenesThatAreNotThereAreRefusedWithTheirPlace)
{
    RunningSession run(folder, tiny_script("vsync: record", "[seen]",
                                      "  seen: {task: rating, prompt: how, scale: {min: 1, max: 7}, "
                                      "cross: [bounces], settings: {scene: none.glb}}\n"));
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("x.yaml:11:"), std::string::npos) << o.err;
    EXPECT_NE(o.err.find("there is no scene 'none.glb'"), std::string::npos) << o.err;
}

TEST_F(Sessions, SettingsThatTheRendererDoesNotKnowAreRefusedAtOnce)
{
    RunningSession run(folder, tiny_script("vsync: record", "[seen]",
                                      "  seen: {task: rating, prompt: how, scale: {min: 1, max: 7}, "
                                      "cross: [bounces], settings: {no_such_thing: 1}}\n"));
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("x.yaml:11:"), std::string::npos) << o.err;
    EXPECT_NE(o.err.find("no_such_thing"), std::string::npos) << o.err;
}

} // namespace
} // namespace viewer::test
