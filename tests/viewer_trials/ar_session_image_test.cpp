// Experiments with stimuli from AR sessions through the program: checked, prepared, simulated, shown.

#include "tests/viewer_trials/running_session.h"

namespace viewer::test {
namespace {

/// Stills are all that a slow machine needs to show.
constexpr char const* kArScript = R"(schema: study/1
id: augmented
seed: 4
participants: {count: 2}
timing: {vsync: record, on_bad_trial: keep, expected_hz: 20, calibrate: {frames: 50}}
factors:
  picture: {truth: {ar.show: truth}, one: {ar.render.paths: 1}, moving: {ar.show: camera, ar.from_s: 0.03}}
defaults: {settings: {ar: desk/session.yaml, ar.poses: poses.csv}, iti_ms: 100, isi_ms: 200, stimulus_ms: 300, stimuli: STIMULI}
sequence: [real]
record: {markers: [udp]}
blocks:
  real: {task: rating, prompt: how real, scale: {min: 1, max: 7}, cross: [picture]}
)";

std::string script(std::string const& stimuli)
{
    std::string text = kArScript;
    return text.replace(text.find("STIMULI"), 7, stimuli);
}

class ArExperiments : public OnScreen {
protected:
    void SetUp() override
    {
        OnScreen::SetUp();
        if (IsSkipped() || std::filesystem::exists(folder / "desk")) return;
        run_well("ar synthesize desk --frames 3 --size 64x48 --paths 2", folder.path());
    }
    void expect_shown(std::string const& stimuli, std::string const& more)
    {
        std::filesystem::remove_all(folder / "data");
        RunningSession session(folder, script(stimuli), more);
        if (!session.window().key_problem().empty()) GTEST_SKIP() << "SKIPPED: " << session.window().key_problem();
        for (int i = 0; i < 3; ++i) {
            ASSERT_TRUE(session.markers.wait_for("stimulus").is_object()) << session.program().errors();
            sleep_ms(400);
            session.window().tap("5");
            session.window().tap("Return");
        }
        Outcome const o = session.wait();
        EXPECT_EQ(o.code, 0) << o.err;
        auto const trials = session.entries<study::TrialDone>();
        ASSERT_EQ(trials.size(), 3u);
        std::set<std::string> digits;
        for (study::TrialDone const& t : trials) {
            digits.insert(t.shown.at(0).settings_sha256);
            EXPECT_EQ(t.value, 5);
        }
        EXPECT_EQ(digits.size(), 3u);
    }
    static inline TemporaryFolder folder;
};

TEST_F(ArExperiments, AreShownLive) { expect_shown("live", ""); }

TEST_F(ArExperiments, AreShownPrepared)
{
    std::ofstream(folder / "x.yaml") << script("prepared");
    Outcome const made = run("study prepare x.yaml --size 240x180 --font 12 --out prepared", folder.path());
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_NE(made.out.find("3 stimuli, 3 rendered"), std::string::npos) << made.out;
    expect_shown("prepared", "--prepared prepared");
}

TEST_F(ArExperiments, AreCheckedAtTheLineThatIsToBlame)
{
    auto const checked = [&](std::string const& from, std::string const& to) {
        std::string text = script("live");
        text.replace(text.find(from), from.size(), to);
        std::ofstream(folder / "x.yaml") << text;
        Outcome const o = run("study check x.yaml", folder.path());
        EXPECT_EQ(o.code, to == from ? 0 : 2) << o.err;
        return to == from ? o.out : o.err;
    };
    EXPECT_NE(checked("paths: 1", "paths: 1").find("3 stimuli from AR sessions"), std::string::npos);
    EXPECT_NE(checked("paths: 1", "paths: 0").find("x.yaml:7:61: "), std::string::npos);
    EXPECT_NE(checked("show: truth", "show: trut").find("x.yaml:7:30: "), std::string::npos);
    EXPECT_NE(checked("from_s: 0.03", "from_s: 1").find("frames end before"), std::string::npos);
    EXPECT_NE(checked("poses.csv", "none.csv").find("x.yaml:8:56: "), std::string::npos);
    EXPECT_NE(checked("desk/session", "desk/sesion").find("x.yaml:8:27: "), std::string::npos);
    std::string session = file_text(folder / "desk/session.yaml");
    session.replace(session.find("paths: 4"), 8, "paths: -4");
    std::ofstream(folder / "desk/bad.yaml") << session;
    EXPECT_NE(checked("desk/session", "desk/bad").find("desk/bad.yaml:"), std::string::npos);
}

} // namespace
} // namespace viewer::test
