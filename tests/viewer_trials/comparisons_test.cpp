#include "viewer/study/comparisons.h"

#include "study/script/script_file.h"
#include "viewer/experiment/stimuli/idle_settings.h"
#include "viewer/experiment/stimuli/stimulus_check.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

/// @param reference  of the script; empty = none
Comparisons comparisons_of(std::string const& compare, std::string const& procedure,
                           std::string const& reference = "")
{
    std::string const text = fmt::format(
        "schema: study/2\nid: t\nseed: 5\nparticipants: {{count: 2}}\n"
        "factors: {{scene: [cornell, mirror], exact: {{exact: {{method: reference}}, cached: {{method: "
        "paths}}}}}}\n"
        "{}sequence: [seen]\nblocks:\n  seen:\n    task: 2ifc\n    stimulus_ms: 500\n    isi_ms: 100\n    prompt: "
        "\"Which?\"\n    cross: [scene]\n"
        "    only: {{exact: [cached]}}\n    compare: {{{}}}\n    procedure: {}\n",
        reference, compare, procedure);
    study::Script const s = study::parse_script(text, "t.yaml");
    return find_comparisons(s, make_plan(s, 1));
}

std::string first(std::vector<std::string> const& list) { return list.empty() ? "" : list.front(); }

constexpr char const* kFollowing =
    "{method: staircase, up: 1, down: 2, start: 0.8, steps: [0.2, 0.1], stop: {reversals: 8, max_trials: 40}}";

constexpr char const* kConstant = "{method: constant, levels: [1, 2, 4], trials_per_level: 4}";

TEST(Comparisons, SayWhatIsBesideWhat)
{
    EXPECT_EQ(first(comparisons_of("vary: exposure, range: [0, 1], against: {}, harder: down", kFollowing).texts),
              "block seen compares exposure 0 to 1 with 0 (lower is harder)");
    EXPECT_EQ(
        first(comparisons_of("vary: exposure, range: [0, 1], against: {exact: exact}, harder: down", kFollowing)
                  .texts),
        "block seen compares exposure 0 to 1 with 0 (lower is harder); the two also differ in method");
}

TEST(Comparisons, DoubtTheWrongEnd)
{
    auto const doubt = [](std::string const& rest, std::string const& procedure = kFollowing) {
        return first(comparisons_of("vary: exposure, against: {}, " + rest, procedure).doubts);
    };
    EXPECT_EQ(doubt("range: [0, 1], harder: down"), "");
    EXPECT_EQ(doubt("range: [-1, 0], harder: up", "{method: constant, levels: [-1, 0], trials_per_level: 4}"), "");
    EXPECT_NE(doubt("range: [0, 1], harder: up").find("write harder: down"), std::string::npos);
    EXPECT_NE(doubt("range: [0.5, 1], harder: up").find("write harder: down"), std::string::npos);
    EXPECT_NE(doubt("range: [-1, 2], harder: down").find("lies within the range"), std::string::npos);
    EXPECT_EQ(first(comparisons_of("vary: exposure, against: {}, range: [-1, 2], harder: down",
                                   "{method: constant, levels: [-1, 0, 1, 2], trials_per_level: 4}")
                        .doubts),
              "")
        << "whole functions may have both sides";
    EXPECT_EQ(
        first(comparisons_of("vary: exposure, against: {exact: exact}, range: [0, 1], harder: up", kFollowing)
                  .doubts),
        "")
        << "stimuli that differ in more are never alike";
}

TEST(Comparisons, KnowThatFactorsOnAScenesLightAreOneByDefault)
{
    auto const doubt = [](std::string const& key) {
        return first(
            comparisons_of("vary: " + key + ", range: [1, 4], against: {}, harder: up", kConstant).doubts);
    };
    EXPECT_NE(doubt("light.0.scale").find("write harder: down"), std::string::npos);
    EXPECT_NE(doubt("material.floor.emission_scale").find("write harder: down"), std::string::npos);
    EXPECT_EQ(doubt("material.floor.roughness"), "") << "the scene has it";
}

TEST(Comparisons, DoubtStaircasesThatStartWhereNothingIsSeen)
{
    std::string const at_0 =
        "{method: staircase, up: 1, down: 2, start: 0, steps: [0.1], stop: {reversals: 8, max_trials: 40}}";
    Comparisons const c = comparisons_of("vary: exposure, range: [0, 1], against: {}, harder: down", at_0);
    EXPECT_NE(first(c.doubts).find("starts at 0, where the two stimuli are alike"), std::string::npos)
        << first(c.doubts);
}

TEST(IdleSettings, AreThoseThatNoMethodUses)
{
    auto const idle = [](std::string const& levels) {
        study::Script const s = study::parse_script(
            "schema: study/2\nid: t\nseed: 5\nparticipants: {count: 2}\nfactors: {scene: [cornell], f: {" +
                levels +
                "}}\nsequence: [b]\nblocks:\n  b: {task: rating, scale: {min: 1, max: 5}, cross: [scene, f], "
                "stimulus_ms: 500}\n",
            "t.yaml");
        StimulusCollection stimuli(s, {});
        study::Mistakes m;
        stimuli.add(make_plan(s, 1), m);
        EXPECT_TRUE(m.empty());
        return first(find_idle_settings(s, stimuli.list()));
    };
    EXPECT_NE(idle("few: {light_paths: 8}, many: {light_paths: 64}")
                  .find("'light_paths' is varied, but changes no picture"),
              std::string::npos);
    EXPECT_EQ(idle("few: {light_paths: 8, method: vpl_exact}, many: {light_paths: 64, method: vpl_exact}"), "");
    EXPECT_EQ(idle("one: {bounces: 1}, two: {bounces: 2}"), "");
    EXPECT_EQ(idle("one: {exposure: 1}, two: {exposure: 2}"), "");
}

TEST(Comparisons, DoubtCrossedFactorsThatOneSideDoesNotFollow)
{
    Comparisons const c =
        comparisons_of("vary: exposure, range: [0, 1], against: {scene: mirror}, harder: down", kFollowing);
    EXPECT_NE(first(c.doubts).find("factor 'scene' is crossed"), std::string::npos) << first(c.doubts);
    EXPECT_NE(first(c.texts).find("differ in scene"), std::string::npos) << first(c.texts);
}

} // namespace
} // namespace viewer::test
