#include "viewer/study/comparisons.h"

#include "study/script/script_file.h"

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
    EXPECT_EQ(doubt("range: [-1, 0], harder: up", "{method: constant, levels: [-1, 0], trials: 4}"), "");
    EXPECT_NE(doubt("range: [0, 1], harder: up").find("write harder: down"), std::string::npos);
    EXPECT_NE(doubt("range: [0.5, 1], harder: up").find("write harder: down"), std::string::npos);
    EXPECT_NE(doubt("range: [-1, 2], harder: down").find("lies within the range"), std::string::npos);
    EXPECT_EQ(first(comparisons_of("vary: exposure, against: {}, range: [-1, 2], harder: down",
                                   "{method: constant, levels: [-1, 0, 1, 2], trials: 4}")
                        .doubts),
              "")
        << "whole functions may have both sides";
    EXPECT_EQ(
        first(comparisons_of("vary: exposure, against: {exact: exact}, range: [0, 1], harder: up", kFollowing)
                  .doubts),
        "")
        << "stimuli that differ in more are never alike";
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
