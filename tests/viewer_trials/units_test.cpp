// The parts that need no window.

#include "gi/core/error.h"
#include "study/numeric/random.h"
#include "study/run/adaptive_run.h"
#include "study/script/examples.h"
#include "study/script/script_file.h"
#include "tests/viewer/run_program.h"
#include "viewer/experiment/answer_keys.h"
#include "viewer/experiment/experimenter.h"
#include "viewer/experiment/page.h"
#include "viewer/experiment/prepared_list.h"
#include "viewer/experiment/response.h"
#include "viewer/experiment/screens/refresh.h"
#include "viewer/experiment/stimuli/stimulus_settings.h"
#include "viewer/experiment/text_entry.h"
#include "viewer/experiment/trial.h"
#include "viewer/protocol/remote/remote_client.h"
#include "viewer/study/setting_lookup.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <future>
#include <gtest/gtest.h>
#include <numeric>

namespace viewer::test {
namespace {

using Kind = PageLine::Kind;

InputEvent key(int code, InputAction action = InputAction::press)
{
    InputEvent e;
    e.kind = InputKind::key;
    e.code = code;
    e.action = action;
    e.time = InputEvent::Clock::now();
    return e;
}

study::Script script(std::string const& block, std::string const& more = "")
{
    return study::parse_script(R"(schema: study/1
id: x
seed: 1
participants: {count: 2}
factors: {scene: [cornell, atrium]}
sequence: [b]
)" + more + "blocks:\n  b: " + block +
                                   "\n",
                               "x.yaml");
}

study::Script rating() { return script("{task: rating, prompt: how, scale: {min: 1, max: 7}, cross: [scene]}"); }

TEST(Page, ParagraphsListsHeadings)
{
    auto const lines = parse_page("# The *task*\n\nFirst line\nsecond line\n\n- one\n  goes on\n2. two\n\n\n");
    std::vector<PageLine> const expected{{Kind::heading, "The task"},
                                         {Kind::gap, ""},
                                         {Kind::text, "First line second line"},
                                         {Kind::gap, ""},
                                         {Kind::item, "\xE2\x80\xA2 one goes on"},
                                         {Kind::item, "2. two"}};
    ASSERT_EQ(lines.size(), expected.size());
    for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(lines[i], expected[i]) << i << ": " << lines[i].text;
}

TEST(Page, OddTextsStayText)
{
    EXPECT_TRUE(parse_page("").empty());
    EXPECT_TRUE(parse_page("\n\n \r\n").empty());
    EXPECT_EQ(parse_page("###")[0].kind, Kind::heading);
    EXPECT_EQ(parse_page("2026 was a year")[0].text, "2026 was a year");
    EXPECT_EQ(parse_page("a \\* b")[0].text, "a * b");
}

TEST(Refresh, DroppedRefreshesAreCounted)
{
    double const period = 1.0 / 60;
    EXPECT_EQ(dropped_between(period, period), 0);
    EXPECT_EQ(dropped_between(1.19 * period, period), 0);
    EXPECT_EQ(dropped_between(1.3 * period, period), 1) << "late is not there";
    EXPECT_EQ(dropped_between(2 * period, period), 1);
    EXPECT_EQ(dropped_between(7.1 * period, period), 6);
    EXPECT_EQ(dropped_between(1, 0), 0);
    EXPECT_EQ(dropped_between(std::nan(""), period), 0);
}

std::vector<double> swaps(int count, double period, double jitter = 0)
{
    std::vector<double> s;
    for (int i = 0; i < count; ++i) s.push_back(100 + i * period + (i % 2 == 0 ? jitter : -jitter));
    return s;
}

TEST(Refresh, ADisplayThatKeepsTimePasses)
{
    study::Timing const timing;
    auto const good = judge_refresh(swaps(600, 1 / 60.0), 60, timing, "oml");
    EXPECT_TRUE(good.passed) << good.reason;
    EXPECT_NEAR(good.period_mean_ms, 1e3 / 60, 1e-6);
    EXPECT_NEAR(good.period_sd_ms, 0, 1e-6);
    EXPECT_EQ(good.frames, 600);
}

TEST(Refresh, WhyADisplayDoesNotPassIsSaid)
{
    study::Timing const timing;
    auto const fast = judge_refresh(swaps(600, 1e-4), 0, timing, "swap_finish");
    EXPECT_FALSE(fast.passed);
    EXPECT_NE(fast.reason.find("do not wait for the display"), std::string::npos) << fast.reason;
    EXPECT_NE(fast.reason.find("the display does not report its rate"), std::string::npos) << fast.reason;
    auto const half = judge_refresh(swaps(600, 1 / 30.0), 60, timing, "oml");
    EXPECT_NE(half.reason.find("instead of 16.7 ms"), std::string::npos) << half.reason;
    EXPECT_EQ(half.reason.find("expected_hz"), std::string::npos) << half.reason;
    auto const shaky = judge_refresh(swaps(600, 1 / 60.0, 2e-3), 60, timing, "oml");
    EXPECT_NE(shaky.reason.find("standard deviation"), std::string::npos) << shaky.reason;
    EXPECT_FALSE(judge_refresh(swaps(2, 1 / 60.0), 60, timing, "oml").passed);
    EXPECT_FALSE(judge_refresh({}, 60, timing, "oml").passed);
}

TEST(Panes, LieSideBySideWithoutOverlap)
{
    for (std::size_t const count : {1u, 2u, 3u, 5u}) {
        auto const panes = panes_for(count, {960, 600}, 140);
        ASSERT_EQ(panes.size(), count);
        for (std::size_t i = 0; i < count; ++i) {
            EXPECT_EQ(panes[i].size_px, panes[0].size_px);
            EXPECT_EQ(panes[i].size_px.y, 460);
            EXPECT_LE(panes[i].corner_px.x + panes[i].size_px.x, 960);
            if (i > 0) {
                EXPECT_GT(panes[i].corner_px.x, panes[i - 1].corner_px.x + panes[i - 1].size_px.x);
            }
        }
    }
    EXPECT_EQ(panes_for(1, {100, 60}, 140)[0].size_px.y, 30) << "half of it is the pictures' in any case";
    EXPECT_GE(panes_for(9, {20, 20}, 0)[0].size_px.x, 1);
}

TEST(AnswerKeys, ScriptsBindingsReplaceTheUsualOnes)
{
    study::Script const plain = script("{task: pair, pairs: {factor: scene}}");
    EXPECT_EQ(AnswerKeys(plain).given(key(GLFW_KEY_LEFT), {"first", "second"})->answer, "first");
    EXPECT_FALSE(AnswerKeys(plain).given(key(GLFW_KEY_LEFT, InputAction::release), {"first"}));
    EXPECT_FALSE(AnswerKeys(plain).given(key(GLFW_KEY_LEFT), {"second"})) << "not asked for";
    study::Script const bound =
        script("{task: pair, pairs: {factor: scene}}", "devices: {first: [key:a, pad:lb], second: [key:l]}\n");
    AnswerKeys const keys(bound);
    EXPECT_FALSE(keys.given(key(GLFW_KEY_LEFT), {"first", "second"}));
    auto const given = keys.given(key(GLFW_KEY_L), {"first", "second"});
    ASSERT_TRUE(given);
    EXPECT_EQ(given->answer, "second");
    EXPECT_EQ(given->input, "key:l");
    InputEvent pad = key(GLFW_GAMEPAD_BUTTON_LEFT_BUMPER);
    pad.kind = InputKind::gamepad_button;
    EXPECT_EQ(keys.given(pad, {"first"})->input, "pad:lb");
}

TEST(AnswerKeys, InputsOfTheScriptGiveNoOtherAnswer)
{
    study::Script const s =
        script("{task: pair, pairs: {factor: scene}, ties: true}", "devices: {neither: [key:left]}\n");
    AnswerKeys const keys(s);
    EXPECT_EQ(keys.given(key(GLFW_KEY_LEFT), {"first", "second", "neither"})->answer, "neither");
    EXPECT_EQ(keys.input_of("first"), "x") << "the gamepad is left to it";
}

TEST(AnswerKeys, UnknownInputsAreRefused)
{
    for (char const* const input : {"key:nothing", "pad:q", "mouse:fourth"}) {
        study::Script const s = script("{task: pair, pairs: {factor: scene}}",
                                       fmt::format("devices: {{first: [{}], second: [key:l]}}\n", input));
        EXPECT_THROW(AnswerKeys{s}, gi::InputError) << input;
    }
}

TEST(AnswerKeys, EveryMistakeIsToldWithItsPlace)
{
    study::Mistakes mistakes;
    find_wrong_devices(script("{task: pair, pairs: {factor: scene}}",
                              "devices:\n  first: [pad:dpad_up, key:a]\n  second: [key:nothing]\n"),
                       mistakes);
    auto const told = mistakes.in_order();
    ASSERT_EQ(told.size(), 2u);
    EXPECT_TRUE(std::string(told[0].what()).starts_with("x.yaml:8:3: devices: first: pad:dpad_up"))
        << told[0].what();
    EXPECT_TRUE(std::string(told[1].what()).starts_with("x.yaml:9:3: devices: second: key:nothing"));
    study::Mistakes taken;
    find_wrong_devices(script("{task: pair, pairs: {factor: scene}, ties: true}",
                              "devices: {neither: [key:left, pad:x, xr:left/trigger]}\n"),
                       taken);
    ASSERT_EQ(taken.count(), 1u);
    EXPECT_NE(std::string(taken.in_order()[0].what()).find("all default inputs of 'first'"), std::string::npos);
}

TEST(AnswerKeys, NoneIsWhatEndsSessionsOrTypesAnswers)
{
    auto const told = [](std::string const& block, std::string const& devices) {
        study::Mistakes mistakes;
        find_wrong_devices(script(block, devices), mistakes);
        return mistakes.empty() ? "" : std::string(mistakes.in_order()[0].what());
    };
    std::string const rating = "{task: rating, scale: {min: 1, max: 7}, cross: scene}",
                      pair = "{task: pair, pairs: {factor: scene}}";
    EXPECT_NE(told(rating, "devices: {confirm: [key:escape]}\n").find("ends a session"), std::string::npos);
    EXPECT_NE(told(rating, "devices: {confirm: [key:5]}\n").find("digits are typed as answers in rating of block"),
              std::string::npos);
    EXPECT_EQ(told(pair, "devices: {first: [key:1], second: [key:2]}\n"), "");
}

TEST(AnswerKeys, ShippedScriptsCanBeAnswered)
{
    for (study::StudyExample const& e : study::study_examples()) {
        study::Mistakes mistakes;
        find_wrong_devices(study::parse_script(std::string(e.text), std::string(e.name)), mistakes);
        EXPECT_EQ(mistakes.count(), 0u) << e.name;
    }
}

TEST(Response, ScaleByDigitsByStepsAndByMouse)
{
    study::Script const s = rating();
    AnswerKeys const keys(s);
    study::Block const& block = s.blocks[0];
    Response digit(block, keys, "a");
    EXPECT_FALSE(digit.take(key(GLFW_KEY_9))) << "not on the scale";
    EXPECT_FALSE(digit.take(key(GLFW_KEY_SPACE))) << "nothing is chosen";
    EXPECT_TRUE(digit.take(key(GLFW_KEY_KP_6)));
    EXPECT_EQ(digit.value(), 6);
    EXPECT_EQ(digit.response(), "confirm");
    Response steps(block, keys, "a");
    EXPECT_FALSE(steps.take(key(GLFW_KEY_UP))) << "begins in the middle";
    EXPECT_FALSE(steps.take(key(GLFW_KEY_UP)));
    EXPECT_TRUE(steps.take(key(GLFW_KEY_SPACE)));
    EXPECT_EQ(steps.value(), 5);
    Response mouse(block, keys, "a");
    EXPECT_FALSE(mouse.click(-1));
    EXPECT_FALSE(mouse.click(7));
    EXPECT_TRUE(mouse.click(0));
    EXPECT_EQ(mouse.value(), 1);
    EXPECT_EQ(mouse.given()->input, "mouse:left");
}

TEST(Response, OrdersNameEachStimulusOnce)
{
    study::Script const s = script("{task: ranking, prompt: sort, rank: {factor: scene}}");
    AnswerKeys const keys(s);
    Response r(s.blocks[0], keys, "ba");
    EXPECT_FALSE(r.take(key(GLFW_KEY_3)));
    EXPECT_FALSE(r.take(key(GLFW_KEY_2)));
    EXPECT_FALSE(r.take(key(GLFW_KEY_2))) << "it has its place";
    EXPECT_FALSE(r.take(key(GLFW_KEY_BACKSPACE)));
    EXPECT_FALSE(r.take(key(GLFW_KEY_1)));
    EXPECT_TRUE(r.take(key(GLFW_KEY_2)));
    EXPECT_EQ(r.response(), "ba");
}

TEST(Response, NumbersAreTypedAndPositive)
{
    study::Script const s = script("{task: magnitude, prompt: how bright, cross: [scene]}");
    AnswerKeys const keys(s);
    Response r(s.blocks[0], keys, "a");
    auto const type = [&](char c) {
        InputEvent e;
        e.kind = InputKind::character;
        e.code = c;
        return r.take(e);
    };
    EXPECT_FALSE(r.take(key(GLFW_KEY_ENTER)));
    type('0');
    EXPECT_FALSE(r.take(key(GLFW_KEY_ENTER))) << "0 is no magnitude";
    for (char const c : std::string(".x2.5")) type(c);
    EXPECT_TRUE(r.take(key(GLFW_KEY_ENTER)));
    EXPECT_DOUBLE_EQ(*r.value(), 0.25);
}

TEST(Response, ADecimalCommaIsAPoint)
{
    study::Script const s = script("{task: magnitude, prompt: how bright, cross: [scene]}");
    AnswerKeys const keys(s);
    Response r(s.blocks[0], keys, "a");
    for (char const c : std::string("5,,.5")) {
        InputEvent e;
        e.kind = InputKind::character;
        e.code = c;
        r.take(e);
    }
    EXPECT_TRUE(r.take(key(GLFW_KEY_ENTER)));
    EXPECT_DOUBLE_EQ(*r.value(), 5.5);
}

/// Messages of a running experiment to its clients.
nlohmann::json asked(Experimenter& experimenter, std::filesystem::path const& socket,
                     nlohmann::json const& request)
{
    auto answer = std::async(std::launch::async, [&] { return RemoteClient(socket).ask(request); });
    while (answer.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) experimenter.poll(1);
    return answer.get();
}

InputEvent typed(int unicode)
{
    InputEvent e;
    e.kind = InputKind::character;
    e.code = unicode;
    return e;
}

TEST(TextEntry, IsEditedByCharactersNotBytes)
{
    TextEntry t(1, 6, "é€");
    EXPECT_EQ(t.cursor(), 5u);
    t.take(typed(0x1f600)); // four bytes
    t.take(key(GLFW_KEY_LEFT));
    t.take(key(GLFW_KEY_BACKSPACE));
    EXPECT_EQ(t.text(), "é😀");
    EXPECT_EQ(t.cursor(), 2u);
    t.take(key(GLFW_KEY_DELETE));
    t.take(key(GLFW_KEY_DELETE)); // nothing is there
    EXPECT_EQ(t.text(), "é");
    t.take(key(GLFW_KEY_HOME));
    t.take(key(GLFW_KEY_BACKSPACE));
    for (int const c : {'"', ',', '<'}) t.take(typed(c));
    t.take(key(GLFW_KEY_END));
    for (int const c : {0x142, int('x'), int('y')}) t.take(typed(c));
    EXPECT_EQ(t.text(), "\",<éłx") << "at most six characters";
    EXPECT_TRUE(t.is_full());
    t.take(key(GLFW_KEY_ENTER));
    EXPECT_EQ(t.text().find('\n'), std::string::npos) << "one line";
}

TEST(TextEntry, OfSeveralLinesMovesBetweenThem)
{
    TextEntry t(3, 100);
    for (int const c : {'a', 'b', 'c'}) t.take(typed(c));
    t.take(key(GLFW_KEY_ENTER));
    t.take(typed('d'));
    t.take(key(GLFW_KEY_UP));
    t.take(typed('1'));
    t.take(key(GLFW_KEY_END));
    t.take(key(GLFW_KEY_DOWN));
    t.take(typed('2'));
    EXPECT_EQ(t.text(), "a1bc\nd2");
    InputEvent done = key(GLFW_KEY_ENTER);
    done.modifiers = GLFW_MOD_CONTROL;
    t.take(done);
    EXPECT_EQ(t.text(), "a1bc\nd2") << "control and enter ends it";
}

TEST(Experimenter, NotesHaveText)
{
    TemporaryFolder const folder;
    gi::Report report;
    RemoteOptions remote;
    remote.socket = folder / "s";
    Experimenter experimenter(remote, report);
    nlohmann::json request{{"do", "session"}, {"action", "note"}};
    EXPECT_TRUE(asked(experimenter, remote.socket, request).contains("error"));
    request["text"] = " ";
    EXPECT_TRUE(asked(experimenter, remote.socket, request).contains("error"));
    EXPECT_TRUE(experimenter.take_notes().empty());
    request["text"] = "late";
    EXPECT_TRUE(asked(experimenter, remote.socket, request).contains("result"));
    ASSERT_EQ(experimenter.take_notes().size(), 1u);
}

TEST(Experimenter, SaysWhoEndsASession)
{
    gi::Report report;
    Experimenter experimenter({}, report);
    EXPECT_NO_THROW(experimenter.check_aborted());
    experimenter.abort("aborted by the participant");
    experimenter.abort("interrupted");
    try {
        experimenter.check_aborted();
        FAIL();
    } catch (study::Aborted const& e) {
        EXPECT_STREQ(e.what(), "aborted by the participant") << "the first";
    }
}

TEST(Stimuli, ScenesAreLookedForBesideTheScript)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "room.glb") << "";
    StimulusSettings const beside = stimulus_settings({{"scene", "room.glb"}}, "", folder.path());
    EXPECT_EQ(beside.scene, (folder / "room.glb").string());
    EXPECT_EQ(stimulus_settings({{"scene", "cornell"}}, "", folder.path()).scene, "cornell");
    StimulusSettings const other = stimulus_settings({{"scene", "room.glb"}}, "");
    EXPECT_EQ(other.scene, "room.glb");
    EXPECT_EQ(beside.sha256, other.sha256) << "wherever the script lies";
}

TEST(Stimuli, SettingsOfTheScriptBecomeThoseOfTheRenderer)
{
    StimulusSettings const s = stimulus_settings({{"scene", "atrium"},
                                                  {"camera", "arches"},
                                                  {"bounces", "2"},
                                                  {"gi.denoise", "none"},
                                                  {"light.0.intensity", "[1, 2, 3]"}},
                                                 "path:orbit");
    EXPECT_EQ(s.scene, "atrium");
    EXPECT_EQ(s.camera, "arches");
    EXPECT_EQ(s.path, StimulusPath::orbit);
    EXPECT_EQ(s.settings.render.bounces, 2);
    EXPECT_EQ(s.settings.denoise, "none");
    ASSERT_EQ(s.edits.size(), 1u);
    EXPECT_EQ(s.edits[0].value, nlohmann::json({1, 2, 3}));
    EXPECT_EQ(s.sha256.size(), 64u);
    // Scripts of schema study/1 are of version 0.1.
    auto const method_of = [](study::Patch const& patch, MadeFor made) {
        return stimulus_settings(patch, "", {}, made).settings.method;
    };
    EXPECT_EQ(method_of({{"scene", "cornell"}, {"gi.method", "slhb"}, {"look_ups", "all"}}, MadeFor::version_0_1),
              "slhb_0_1");
    EXPECT_EQ(method_of({{"scene", "cornell"}}, MadeFor::version_0_1), "slhb_0_1");
    EXPECT_EQ(method_of({{"scene", "cornell"}}, MadeFor::this_version), "auto");
    EXPECT_EQ(method_of({{"scene", "cornell"}, {"method", "slhb"}}, MadeFor::this_version), "slhb");
    EXPECT_THROW(method_of({{"scene", "cornell"}, {"look_ups", "all"}}, MadeFor::this_version), gi::InputError);
    EXPECT_EQ(s.sha256, stimulus_settings({{"gi.scene", "atrium"},
                                           {"gi.denoise", "none"},
                                           {"camera", "arches"},
                                           {"gi.bounces", "2"},
                                           {"light.0.intensity", "[1,2,3]"}},
                                          "path:orbit")
                            .sha256)
        << "what is the same has the same digits";
    EXPECT_NE(s.sha256, stimulus_settings({{"scene", "atrium"}}, "").sha256);
}

TEST(Stimuli, WholeSettingsTakeTheNearestLevel)
{
    EXPECT_EQ(stimulus_settings({{"scene", "cornell"}, {"paths", "2.82842712"}}, "").settings.paths, 3);
    EXPECT_THROW(stimulus_settings({{"scene", "cornell"}, {"paths", "few"}}, ""), gi::InputError);
}

TEST(Stimuli, WholeSettingsHaveNoFractionsAndNoEqualLevels)
{
    auto const told = [](std::string const& setting, std::string const& levels) -> std::string {
        std::string const text =
            "schema: study/1\nid: t\nseed: 1\nparticipants: {count: 1}\nfactors: {q: {a: {" + setting +
            "}}}\nreference: {q: a}\ndefaults: {stimulus_ms: 300}\nsequence: [b]\nblocks:\n  b:\n    task: 2ifc\n"
            "    compare: {vary: paths, range: [1, 4], harder: up}\n    procedure: {method: constant, levels: " +
            levels + "}\n";
        study::Mistakes mistakes;
        find_wrong_settings(study::parse_script(text, "x.yaml"), text, "", mistakes);
        return mistakes.empty() ? "" : mistakes.in_order()[0].what();
    };
    EXPECT_EQ(told("exposure: 0.5", "[1, 2.4, 3]"), "");
    EXPECT_EQ(told("gi.bounces: 4.0", "[1, 4]"), "");
    EXPECT_EQ(told("gi.bounces: 0.5", "[1, 4]"),
              "x.yaml:5:31: 'bounces' = 0.5 (it takes whole numbers) write 0 or 1");
    EXPECT_TRUE(told("exposure: 0", "[1, 1.4, 3]").starts_with("x.yaml:12:21: 'paths' with the levels 1 and 1.4"));
    EXPECT_TRUE(told("exposure: 0", "1..4/9").starts_with("x.yaml:12:21: 'paths' with the levels 1 and 1.375"));
}

/// Whoever answers whatever: the shipped staircases and QUEST+ never ask for a level that was not prepared.
TEST(Stimuli, OfProceduresAllLevelsThatTheyMayAskForAreKnown)
{
    auto const examples = study::study_examples();
    auto const staircase =
        std::find_if(examples.begin(), examples.end(), [](auto const& e) { return e.name == "staircase"; });
    ASSERT_NE(staircase, examples.end());
    study::Script const s = study::parse_script(std::string(staircase->text), "staircase");
    study::Random random(7);
    int asked = 0;
    for (study::Block const& block : s.blocks) {
        if (!block.compare) continue;
        for (study::Procedure const& p : block.procedures) {
            if (!is_adaptive(p)) continue;
            std::vector<double> const known = reachable_levels(p, *block.compare);
            ASSERT_FALSE(known.empty()) << p.name;
            EXPECT_LE(known.size(), 41u) << p.name;
            for (int run = 0; run < 20; ++run)
                for (study::AdaptiveRun r(p, *block.compare, s.file); !r.finished(); ++asked) {
                    EXPECT_NE(std::find(known.begin(), known.end(), r.level()), known.end()) << r.level();
                    r.respond(random.uniform() < 0.7);
                }
        }
    }
    EXPECT_GT(asked, 500);
    EXPECT_GT(prepared_list(s, {640, 480}, 20, "v").size(), 30u);
}

TEST(Stimuli, WhatTheRendererDoesNotKnowIsRefused)
{
    for (study::Patch const& patch : {study::Patch{},
                                      {{"scene", "cornell"}, {"nothing", "1"}},
                                      {{"scene", "cornell"}, {"bounces", "-1"}},
                                      {{"scene", "cornell"}, {"gi.visibility", "magic"}},
                                      {{"scene", "cornell"}, {"view", "hologram"}}})
        EXPECT_THROW(stimulus_settings(patch, ""), gi::InputError);
    EXPECT_THROW(stimulus_settings({{"scene", "cornell"}}, "path:nowhere"), gi::InputError);
}

} // namespace
} // namespace viewer::test
