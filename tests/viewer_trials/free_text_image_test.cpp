// Texts that a participant types in the window of a session.

#include "tests/support/xvfb.h"
#include "tests/viewer_trials/measured_session.h"

namespace viewer::test {
namespace {

class FreeText : public OnScreen {
protected:
    TemporaryFolder folder;
};

constexpr char const* kWords = R"(schema: study/1
id: words
seed: 4
participants: {count: 1}
timing: {vsync: record, expected_hz: 50, calibrate: {frames: 50}}
sequence: [{questionnaire: q}]
blocks: {}
questionnaires:
  q:
    items:
      - {id: sure, text: "Sure?", required: true}
      - {id: why, text: "Why, in a few words?", type: text, required: true, max_chars: 40}
      - {id: more, text: "What else?", type: text, lines: 3}
)";

/// Types text as from a keyboard that has all characters.
void type(std::string const& text)
{
    ASSERT_EQ(gi::test::run_shell("LC_ALL=C.UTF-8 xdotool type --delay 40 '" + text + "'"), 0) << "xdotool";
    sleep_ms(100);
}

TEST_F(FreeText, IsTypedKeptThroughAKillAndReported)
{
    if (gi::test::run_shell("command -v xdotool > /dev/null") != 0)
        GTEST_SKIP() << "SKIPPED: xdotool is not installed (scripts/setup --tests installs it)";
    {
        RunningSession run(folder, kWords);
        ASSERT_TRUE(run.wait_until_at("questionnaire")) << run.program().errors();
        if (!run.window().key_problem().empty()) GTEST_SKIP() << "SKIPPED: " << run.window().key_problem();
        sleep_ms(300);
        tap_slowly(run.window(), "Tab"); // it is required
        tap_slowly(run.window(), "6");
        tap_slowly(run.window(), "space");
        sleep_ms(200);
        tap_slowly(run.window(), "Return"); // so is the text
        type("She said \"łódź, caffè\" x");
        tap_slowly(run.window(), "BackSpace");
        tap_slowly(run.window(), "Left", 2);
        type("é");
        tap_slowly(run.window(), "Delete");
        tap_slowly(run.window(), "Return");
        sleep_ms(200);
        type("lost");
        EXPECT_EQ(run.entries<study::ItemAnswered>().size(), 2u) << "while the next one is typed";
        run.program().send(SIGKILL);
        run.wait();
    }
    RunningSession run(folder, kWords, "--resume");
    ASSERT_TRUE(run.wait_until_at("questionnaire")) << run.program().errors();
    run.window().focus();
    sleep_ms(300);
    type("one,");
    tap_slowly(run.window(), "Return");
    type("<two>");
    tap_slowly(run.window(), "Prior"); // back, to see the text that was kept
    sleep_ms(200);
    type("!");
    tap_slowly(run.window(), "Return");
    sleep_ms(200);
    run.window().press("Control_L");
    tap_slowly(run.window(), "Return");
    run.window().release("Control_L");
    Outcome const o = run.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    auto const done = run.entries<study::QuestionnaireDone>();
    ASSERT_EQ(done.size(), 1u);
    EXPECT_EQ(done[0].answers, (std::vector<std::optional<double>>{6.0, {}, {}}));
    ASSERT_EQ(done[0].texts.size(), 3u);
    EXPECT_EQ(done[0].texts[1], "She said \"łódź, caffèé !");
    EXPECT_EQ(done[0].texts[2], "one,\n<two>");
    run_well("study export data --script x.yaml --out exported", folder.path());
    std::string const csv = file_text(folder / "exported/data/study-words_description-questionnaires_data.csv");
    EXPECT_NE(csv.find("\"She said \"\"łódź, caffèé !\""), std::string::npos) << csv;
    EXPECT_NE(csv.find("\"one,\n<two>\""), std::string::npos) << csv;
    run_well("study report data --script x.yaml --out r.html", folder.path());
    EXPECT_NE(file_text(folder / "r.html").find("one,\n&lt;two&gt;"), std::string::npos);
}

} // namespace
} // namespace viewer::test
