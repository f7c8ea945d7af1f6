// Live stimuli whose surfaces are drawn between rendered pictures, as the viewer shows them.

#include "tests/viewer_trials/tiny_session.h"

namespace viewer::test {
namespace {

class ShownFrames : public OnScreen {
protected:
    /// Exact and shown frames of a camera that goes round a circle, one after the other.
    static std::string script(std::string const& more = "")
    {
        std::string text =
            tiny_script("vsync: record, on_bad_trial: keep", "[seen]",
                        "  seen: {task: rating, prompt: how, scale: {min: 1, max: 7}, cross: [frames], "
                        "camera: \"path:orbit\"" +
                            more + "}\n");
        for (auto const& [from, to] :
             {std::pair<std::string, std::string>{"{bounces: [0, 2]}", "{frames: [exact, shown]}"},
              {"method: slhb", "method: paths"},
              {"paths: 1, scale: 1", "bounces: 1"}})
            text.replace(text.find(from), from.size(), to);
        return text;
    }
    static std::string tables(std::filesystem::path const& folder)
    {
        std::string all;
        for (auto const& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().filename().string().find("acq-stimuli") != std::string::npos)
                all += file_text(entry.path());
        return all;
    }
    TemporaryFolder folder;
};

TEST_F(ShownFrames, AreDrawnForNewerPosesAndTheRecordsSaySo)
{
    RunningSession run(folder, script());
    NEED_KEYS(run);
    for (int i = 0; i < 2; ++i) {
        ASSERT_TRUE(run.markers.wait_for("stimulus").is_object()) << run.program().errors();
        sleep_ms(1500);
        run.window().tap("3");
        ASSERT_TRUE(run.markers.wait_for("stimulus_end").is_object());
    }
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(o.err.find("surfaces not drawn"), std::string::npos) << o.err;
    int exact = 0, shown = 0;
    for (study::TrialDone const& t : run.entries<study::TrialDone>()) {
        ASSERT_EQ(t.shown.size(), 1u);
        study::StimulusShown const& s = t.shown[0];
        if (s.frames_kind.empty()) {
            ++exact;
            EXPECT_FALSE(s.frames_drawn || s.light_age_ms);
            continue;
        }
        ++shown;
        EXPECT_EQ(s.frames_kind, "shown");
        ASSERT_TRUE(s.frames_drawn && s.light_age_ms);
        EXPECT_GT(*s.frames_drawn, s.frames_shown / 2);
        EXPECT_LT(*s.frames_drawn, s.frames_shown) << "the first frame is a finished picture";
        EXPECT_GT(*s.light_age_ms, 0);
        EXPECT_LT(*s.light_age_ms, 30e3);
    }
    EXPECT_EQ(exact, 1);
    EXPECT_EQ(shown, 1);
    std::string const journal = file_text(run.folder() / "journal.jsonl");
    EXPECT_EQ(journal.find("frames_kind"), journal.rfind("frames_kind")) << "exact trials are recorded as ever";
    std::string const stimuli = tables(run.folder());
    EXPECT_NE(stimuli.find("\tframes_kind\tframes_drawn\tlight_age_ms"), std::string::npos) << stimuli;
    EXPECT_NE(stimuli.find("\texact\tn/a\tn/a"), std::string::npos) << stimuli;
}

TEST_F(ShownFrames, AreDrawnOnWallsToo)
{
    std::ofstream(folder / "corner.yaml") << R"(name: corner
walls:
  - {name: front, lower_left_m: [-1, 0, -1], lower_right_m: [1, 0, -1], upper_left_m: [-1, 2, -1], window: front}
  - {name: right, lower_left_m: [1, 0, -1], lower_right_m: [1, 0, 1], upper_left_m: [1, 2, -1], window: right}
windows:
  - {name: front, size_px: [120, 120], position_px: [0, 0]}
  - {name: right, size_px: [120, 120], position_px: [140, 0]}
users:
  - {name: guest, head_position_m: [0, 1, 0]}
)";
    RunningSession run(folder, script(", stimulus_ms: 1500, timeout_ms: 1600"), "--display corner.yaml");
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    int shown = 0;
    for (study::TrialDone const& t : run.entries<study::TrialDone>())
        if (study::StimulusShown const& s = t.shown.at(0); s.frames_kind == "shown") {
            ++shown;
            EXPECT_GT(s.frames_drawn.value_or(0), s.frames_shown / 2);
        }
    EXPECT_EQ(shown, 1);
}

TEST_F(ShownFrames, AreRefusedWherePicturesAreMadeAhead)
{
    std::ofstream(folder / "x.yaml") << script(", stimuli: prepared");
    Outcome const o = run("study check x.yaml", folder.path());
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("stimuli: prepared with frames: shown"), std::string::npos) << o.err;
}

TEST_F(ShownFrames, OtherWordsAreRefused)
{
    std::string text = script();
    text.replace(text.find("exact, shown"), 12, "exact, fast");
    std::ofstream(folder / "x.yaml") << text;
    Outcome const o = run("study check x.yaml", folder.path());
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("write exact or shown"), std::string::npos) << o.err;
}

} // namespace
} // namespace viewer::test
