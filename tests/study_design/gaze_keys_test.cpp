#include "study/script/script_file.h"
#include "tests/study_design/samples.h"

namespace study::test {
namespace {

Script script_with(std::string const& gaze, std::string const& more = "")
{
    return parse_script(
        "schema: study/1\nid: g\nseed: 1\nparticipants: {count: 1}\nfactors: {scene: [cornell, "
        "atrium]}\n" +
            more +
            "sequence: [one]\nblocks:\n  one: {task: rating, scale: {min: 1, max: 7}, cross: [scene], gaze: " +
            gaze + "}\n",
        "g.yaml");
}

TEST(GazeKeys, SetTheRulesOfABlock)
{
    Script const s = script_with(
        "{start: {within_deg: 1.5, for_ms: 250}, hold: {grace_ms: 50}, follow: {show: mask, radius_deg: 3}}",
        "record: {gaze: 'lsl:Tobii'}\n");
    GazeRules const& g = s.blocks[0].gaze;
    ASSERT_TRUE(g.start && g.hold && g.moving);
    EXPECT_EQ(g.start->within_deg, 1.5);
    EXPECT_EQ(g.start->for_ms, 250);
    EXPECT_EQ(g.start->timeout_ms, 10000);
    EXPECT_EQ(g.hold->grace_ms, 50);
    EXPECT_EQ(g.moving->kind, GazeFollow::mask);
    EXPECT_EQ(g.moving->radius_deg, 3);
    EXPECT_EQ(s.record.gaze, "lsl:Tobii");
}

TEST(GazeKeys, BlocksSwitchOffWhatDefaultsSet)
{
    Script const s = script_with("{hold: none}", "defaults: {gaze: {start: {}, hold: {}}}\n");
    EXPECT_TRUE(s.blocks[0].gaze.start);
    EXPECT_FALSE(s.blocks[0].gaze.hold);
}

TEST(GazeKeys, MistakesAreNamedWithTheirPlace)
{
    for (auto const& [gaze, word] :
         std::vector<std::pair<std::string, std::string>>{{"{begin: {}}", "begin"},
                                                          {"{start: {within_deg: -1}}", "within_deg"},
                                                          {"{start: {for_ms: 500, timeout_ms: 400}}", "timeout"},
                                                          {"{hold: maybe}", "hold"},
                                                          {"{follow: {show: circle}}", "circle"}})
        try {
            script_with(gaze);
            ADD_FAILURE() << gaze;
        } catch (ScriptError const& e) {
            EXPECT_EQ(std::string(e.what()).substr(0, 7), "g.yaml:") << e.what();
            EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
        }
    EXPECT_THROW(script_with("{start: {}}", "record: {gaze: tobii}\n"), ScriptError);
    EXPECT_EQ(script_with("{start: {}}", "record: {gaze: openxr}\n").record.gaze, "openxr");
    EXPECT_THROW(script_with("{start: {}}", "timing: {display_lag_uncertainty_ms: -1}\n"), ScriptError);
}

} // namespace
} // namespace study::test
