// Settings that a display cannot show are reported at their place in the script.

#include "gi/core/file.h"
#include "tests/viewer/run_program.h"
#include "viewer/experiment/stimuli/script_check.h"
#include "viewer/experiment/stimuli/study_scenes.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

std::string const kScript = R"(schema: study/1
id: deg
seed: 1
participants: {count: 1}
factors:
  picture:
    fine: {size: 4 deg, peak_luminance: 50}
    big: {size: 70 deg}
    bright: {peak_luminance: 500 cd/m2}
defaults: {settings: {scene: cornell}}
sequence: [seen]
blocks:
  seen:
    task: rating
    scale: {min: 1, max: 7}
    cross: [picture]
    gaze: {hold: {within_deg: 2}}
)";

study::DisplayModel monitor(double distance_cm)
{
    study::DisplayModel m;
    m.screen = study::ScreenGeometry{1920, 1080, 53.1, 29.87, distance_cm, "typed"};
    m.luminance.emplace();
    m.luminance->black = 0.4;
    for (auto& channel : m.luminance->channels) channel = study::ChannelCurve{33, 2.2, 1, {}, 0, 0, 0};
    return m;
}

std::vector<std::string> told(std::optional<ShownOn> const& shown_on, std::string const& script = kScript)
{
    test::TemporaryFolder const folder;
    std::string const file = (folder.path() / "t.yaml").string();
    gi::write_text(file, script);
    ScriptToCheck read = load_script_to_check(file);
    ScriptCheckOptions options;
    options.stimuli.renders = false;
    options.stimuli.shown_on = shown_on;
    check_script(read, study_scenes(), options);
    std::vector<std::string> out;
    for (study::ScriptError const& e : read.mistakes.in_order())
        out.push_back(std::string(e.what()).substr(std::string(e.what()).find("t.yaml:")));
    return out;
}

void expect_told(std::vector<std::string> const& all, std::size_t i, std::string const& place,
                 std::string const& what)
{
    ASSERT_LT(i, all.size());
    EXPECT_EQ(all[i].substr(0, place.size()), place) << all[i];
    EXPECT_NE(all[i].find(what), std::string::npos) << all[i];
}

TEST(DisplayMistakes, AreToldAtTheirPlaces)
{
    study::DisplayModel const m = monitor(57.3);
    auto const all = told(ShownOn{&m});
    EXPECT_EQ(all.size(), 2u);
    expect_told(all, 0, "t.yaml:8:", "the screen has 1920 x 1080");
    expect_told(all, 1, "t.yaml:9:", "the display shows 0.4 to 99.4 cd/m2");
}

TEST(DisplayMistakes, DegreesNeedADistance)
{
    study::DisplayModel const m = monitor(0);
    auto const all = told(ShownOn{&m});
    ASSERT_EQ(all.size(), 4u);
    expect_told(all, 0, "t.yaml:7:", "no distance");
    expect_told(all, 1, "t.yaml:8:", "no distance");
    expect_told(all, 3, "t.yaml:13:", "degrees need the screen's size and distance");
}

TEST(DisplayMistakes, AreSettingsThatNoPictureCanHaveTogether)
{
    auto const with = [](std::string const& settings, std::string const& more = "") {
        return "schema: study/1\nid: deg\nseed: 1\nparticipants: {count: 1}\nfactors: {exposure: [0, 1]}\n"
               "defaults: {settings: {scene: cornell, " +
               settings + "}" + more +
               "}\nsequence: [seen]\nblocks:\n  seen: {task: rating, scale: {min: 1, max: 7}, cross: exposure}\n";
    };
    study::DisplayModel const m = monitor(57.3);
    auto const edge = told(ShownOn{&m}, with("size: 40 x 4 deg, place: 15 0 deg"));
    ASSERT_EQ(edge.size(), 1u);
    expect_told(edge, 0, "t.yaml:6:", "beyond the edge of the screen's 1920 x 1080 px");
    auto const both = told({}, with("mean_luminance: 20, peak_luminance: 10"));
    ASSERT_EQ(both.size(), 1u);
    expect_told(both, 0, "t.yaml:9:", "mean_luminance and peak_luminance of one stimulus");
    auto const headset = told({}, with("view: openxr", ", stimuli: prepared"));
    ASSERT_EQ(headset.size(), 1u);
    expect_told(headset, 0, "t.yaml:9:", "stimuli: prepared with view: openxr");
}

TEST(DisplayMistakes, WallsHaveNoSizes)
{
    auto const all = told(ShownOn{nullptr, true});
    ASSERT_EQ(all.size(), 5u);
    expect_told(all, 0, "t.yaml:7:", "on walls or in a headset");
    expect_told(all, 4, "t.yaml:13:", "degrees need the screen's size and distance");
}

} // namespace
} // namespace viewer::test
