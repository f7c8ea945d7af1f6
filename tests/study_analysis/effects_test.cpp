// Tests of conditions and of groups of participants.

#include "study/analysis/result_tables.h"
#include "study/observers/observer.h"
#include "study/power/simulated_record.h"
#include "tests/study_analysis/made_sessions.h"

#include <cmath>

namespace study::test {
namespace {

/// 11 people in groups of 6 and 5, as in tests/study_stats/mixed_anova_test.cpp.
Script groups_script()
{
    return parse_script(R"(schema: study/1
id: g
seed: 1
participants: {count: 11}
factors: {group: [old, young], scene: [hall, yard, shed], light: [day, dusk]}
reference: {light: day}
defaults: {stimulus_ms: 2000}
counterbalance: {group: {method: between}}
sequence: [rated]
blocks:
  rated: {task: rating, scale: {min: 1, max: 10}, cross: [scene, light]}
)",
                        "g.yaml");
}

std::vector<RecordedSession> rated_sessions(Script const& s)
{
    int const ratings[11][6] = {{5, 7, 7, 7, 8, 6},  {5, 4, 6, 7, 7, 7},  {2, 4, 3, 6, 6, 6}, {3, 4, 4, 4, 4, 5},
                                {4, 4, 5, 5, 7, 5},  {6, 4, 5, 4, 6, 6},  {5, 5, 6, 8, 8, 7}, {7, 6, 7, 8, 8, 6},
                                {6, 7, 7, 8, 10, 8}, {6, 7, 8, 8, 9, 10}, {6, 6, 7, 6, 6, 7}};
    std::vector<RecordedSession> sessions;
    for (int p = 0; p < 11; ++p) {
        MadeSession made(s, "P" + std::to_string(p + 1));
        for (int c = 0; c < 6; ++c) made.add(0, {{p < 6 ? 0 : 1, c / 2, c % 2}}, "confirm", double(ratings[p][c]));
        sessions.push_back(made.finished());
    }
    return sessions;
}

EffectResult const& effect(Analysis const& a, std::string const& name)
{
    for (EffectResult const& e : a.effects)
        if (e.effect == name) return e;
    std::string known;
    for (EffectResult const& e : a.effects) known += e.block + ", " + e.measure + ": " + e.effect + "\n";
    for (EffectNote const& n : a.effect_notes) known += n.block + ", " + n.measure + ": " + n.text + "\n";
    throw std::runtime_error("no effect " + name + "; there are:\n" + known);
}

TEST(Effects, OfGroupsAndConditionsAreTested)
{
    Script const s = groups_script();
    Analysis const a = analyze(s, rated_sessions(s));
    ASSERT_EQ(a.effects.size(), 7u);
    EXPECT_EQ(effect(a, "group").observers, 11);
    EXPECT_NEAR(effect(a, "group").test.f, 12.63823196814, 1e-9); // statsmodels
    EXPECT_NEAR(effect(a, "group x scene").test.p_gg, 0.80249353669273, 1e-11);
    EXPECT_LT(effect(a, "scene").p_holm, 0.001);
    // The mean of all conditions, then each of six.
    ASSERT_EQ(a.group_differences.size(), 7u);
    EXPECT_EQ(a.group_differences[0].cell, "mean");
    EXPECT_EQ(a.group_differences[0].a, "group=old");
    EXPECT_EQ(a.group_differences[0].test.n_a, 6);
    EXPECT_EQ(a.group_differences[1].cell, "scene=hall light=day");
    EXPECT_GT(a.group_differences[1].p_holm, a.group_differences[1].test.p);
    bool has_effects = false, has_groups = false;
    for (ResultTable const& t : result_tables(a)) {
        has_effects = has_effects || (t.name == "effects" && t.table.rows.size() == 7);
        has_groups = has_groups || (t.name == "group_differences" && t.table.rows.size() == 7);
    }
    EXPECT_TRUE(has_effects && has_groups);
}

TEST(Effects, OfFriedmanHaveNoGapsWhereTheOtherGroupIs)
{
    Script const s = groups_script();
    Analysis const a = analyze(s, rated_sessions(s));
    ASSERT_GE(a.blocks.at(0).scales.size(), 3u);
    for (ScaleResult const& scale : a.blocks[0].scales)
        for (std::string const& note : scale.notes)
            EXPECT_EQ(note.find("left out"), std::string::npos) << scale.group;
    EXPECT_EQ(a.blocks[0].scales[1].group, "group=old");
    EXPECT_EQ(a.blocks[0].scales[1].observers, 6);
}

TEST(Effects, LeaveOutObserversWithoutACellAndSaySo)
{
    Script const s = groups_script();
    auto sessions = rated_sessions(s);
    auto& entries = sessions[2].record.entries;
    entries.erase(entries.end() - 2); // one rating
    Analysis const a = analyze(s, sessions);
    EXPECT_EQ(effect(a, "group").observers, 10);
    ASSERT_EQ(a.effect_notes.size(), 1u);
    EXPECT_NE(a.effect_notes[0].text.find("1 observer lacks a cell"), std::string::npos);
}

TEST(Effects, OfPairsAndThresholdsAreFoundInSimulatedGroups)
{
    Script const s = parse_script(R"(schema: study/1
id: m
seed: 3
participants: {count: 24}
factors: {light: {day: {exposure: 0}, dusk: {exposure: -2}}, method: [exact, good, bad]}
reference: {method: exact}
defaults: {stimulus_ms: 500}
counterbalance: {light: {method: between}}
sequence: [which, seen]
blocks:
  which: {task: pair, pairs: {factor: method}, repeats: 6, ties: true}
  seen:
    task: 2ifc
    only: {method: [exact]}
    compare: {vary: contrast, against: reference, scale: linear, range: [0, 10], harder: down}
    procedure: {method: constant, levels: [1, 3, 4, 5, 6, 8], trials_per_level: 10}
)",
                                  "m.yaml");
    ObserverModel const model = read_observers(R"(quality: {method: {good: -0.5, bad: -1}}
interactions: [{levels: {light: dusk, method: bad}, jod: -2}]
lapse: 0
varied: {contrast: {threshold: 4, slope: 2, between_sd: 0.2, shift: {light: {dusk: 2}}}}
)",
                                               "o.yaml", s);
    std::vector<RecordedSession> sessions;
    for (int p = 1; p <= 24; ++p)
        sessions.push_back(simulated_record(s, make_plan(s, p), draw_observer(model, 9, p)));
    AnalysisSettings settings;
    settings.replicates = 100;
    settings.permutations = 199;
    Analysis const a = analyze(s, sessions, settings);
    EXPECT_LT(effect(a, "light x method").test.p_gg, 0.001);
    EXPECT_LT(effect(a, "light x method").test.p_permutation, 0.01);
    bool has_threshold = false;
    for (EffectResult const& e : a.effects) {
        EXPECT_FALSE(e.block == "which" && e.effect == "light") << "JODs of each observer have the mean 0";
        if (e.measure != "threshold, constant: likelihood" || e.effect != "light") continue;
        has_threshold = true;
        EXPECT_LT(e.test.p, 0.05);
    }
    EXPECT_TRUE(has_threshold);
    ScaleResult const& scale = a.blocks.at(0).scales.at(0);
    EXPECT_NEAR(fact(scale, "threshold of ties JOD"), 0.4, 0.12);
}

TEST(Effects, OfThresholdsNameTheScaleOfTheirLevels)
{
    Script const s = parse_script(R"(schema: study/1
id: m
seed: 3
participants: {count: 4}
factors: {light: [day, dusk], method: [exact]}
reference: {method: exact}
defaults: {stimulus_ms: 500}
sequence: [seen]
blocks:
  seen:
    task: 2ifc
    cross: [light]
    compare: {vary: points, against: reference, scale: log10, range: [1, 100], harder: down}
    procedure: {method: constant, levels: [2, 5, 12, 30, 70], trials_per_level: 8}
)",
                                  "m.yaml");
    ObserverModel const model =
        read_observers("varied: {points: {threshold: 12, slope: 2, between_sd: 0.1}}\n", "o.yaml", s);
    std::vector<RecordedSession> sessions;
    for (int p = 1; p <= 4; ++p)
        sessions.push_back(simulated_record(s, make_plan(s, p), draw_observer(model, 9, p)));
    AnalysisSettings settings;
    settings.draws = 0;
    settings.permutations = 19;
    Analysis const a = analyze(s, sessions, settings);
    EXPECT_TRUE(std::any_of(a.effects.begin(), a.effects.end(), [](EffectResult const& e) {
        return e.measure == "threshold, constant: likelihood, log10 of the level";
    }));
}

} // namespace
} // namespace study::test
