// Power by simulation, compared with the power of the t test that the simulated design has.

#include "study/power/power_study.h"
#include "study/script/script_file.h"

#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace study::test {
namespace {

/// Two groups, two conditions, two ratings of each: the interaction is a t test of two groups' differences.
Script two_by_two()
{
    return parse_script(R"(schema: study/1
id: two
seed: 3
participants: {count: 12}
factors: {light: {day: {exposure: 0}, dusk: {exposure: -2}}, method: [exact, good]}
reference: {method: exact}
defaults: {stimulus_ms: 500}
counterbalance: {light: {method: between}}
sequence: [rated]
blocks:
  rated: {task: rating, cross: [method], repeats: 2, scale: {min: 0, max: 1000}}
)",
                        "two.yaml");
}
ObserverModel interacting(Script const& s)
{
    return read_observers(R"(quality: {method: {good: -0.5}, light: {dusk: -0.3}}
interactions: [{levels: {light: dusk, method: good}, jod: -1}]
between_sd: 0.2
lapse: 0
rating: {best: 0.5, span_jod: 20, between_sd: 0.02}
)",
                          "o.yaml", s);
}

TEST(StudyPower, OfAMixedDesignIsThatOfItsTTest)
{
    Script const s = two_by_two();
    PowerSettings p;
    p.test = "light x method";
    p.effects = {0, 0.5, 1};
    p.participants = {12, 24, 40};
    p.simulations = 400;
    int calls = 0;
    PowerStudy const study = study_power(s, interacting(s), p, [&](double) { return ++calls > 0; });
    EXPECT_TRUE(study.is_complete);
    ASSERT_EQ(study.points.size(), 9u);
    // By the noncentral t distribution (scipy): variance 2 (1.0484^2 / 2 + 0.2^2), groups of 6, 12, 20.
    double const exact[] = {0.05, 0.05, 0.05, 0.1118, 0.1904, 0.2948, 0.3031, 0.5780, 0.8100};
    for (std::size_t i = 0; i < 9; ++i) {
        PowerPoint const& point = study.points[i];
        EXPECT_EQ(point.simulations, 400);
        EXPECT_EQ(point.refused, 0);
        EXPECT_NEAR(point.power, exact[i], 3.5 * std::sqrt(exact[i] * (1 - exact[i]) / 400))
            << point.effect << ", " << point.participants;
        EXPECT_LE(point.interval.low, point.power);
    }
    EXPECT_EQ(power_table(study, p).rows.size(), 9u);
    EXPECT_EQ(nlohmann::json::parse(power_json(study, p))["points"].size(), 9u);
    std::string const page = power_page(s, study, p, "lightwell");
    EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
    EXPECT_NE(page.find("<svg"), std::string::npos);
}

TEST(StudyPower, RecoversDifferencesOfItems)
{
    Script const s = two_by_two();
    PowerSettings p;
    p.test = "exact - good";
    p.participants = {16};
    p.repeats = {1, 4};
    p.simulations = 200;
    p.has_recovery = true;
    PowerStudy const study = study_power(s, interacting(s), p, [](double) { return true; });
    ASSERT_EQ(study.points.size(), 2u);
    EXPECT_EQ(study.unit, "rating");
    for (PowerPoint const& point : study.points) {
        EXPECT_NEAR(point.truth, 50, 6) << "0.5 JOD, and 1 more in half of the people: 50 points of 1000";
        EXPECT_NEAR(point.estimate, 50, 3);
        EXPECT_NEAR(point.coverage, 0.95, 0.06);
    }
    EXPECT_GT(study.points[1].power, study.points[0].power);
    EXPECT_LT(study.points[1].deviation, study.points[0].deviation);
}

TEST(StudyPower, KeepsWhatIsDoneWhenStopped)
{
    Script const s = two_by_two();
    PowerSettings p;
    p.test = "method:light";
    p.participants = {8, 12};
    p.simulations = 1000;
    PowerStudy const study = study_power(s, interacting(s), p, [](double share) { return share < 0.05; });
    EXPECT_FALSE(study.is_complete);
    EXPECT_EQ(study.points[0].simulations, 50);
    EXPECT_EQ(study.points[1].simulations, 50);
    EXPECT_TRUE(std::isfinite(study.points[0].power));
    EXPECT_NE(power_text(study, p).find("50 of 1000 simulations (stopped)"), std::string::npos);
}

TEST(StudyPower, RefusesAnUnknownTestAndNamesTheOthers)
{
    Script const s = two_by_two();
    PowerSettings p;
    p.test = "light x sound";
    p.participants = {8};
    try {
        study_power(s, interacting(s), p, [](double) { return true; });
        FAIL();
    } catch (ScriptError const& e) {
        EXPECT_NE(std::string(e.what()).find("'rating: light x method'"), std::string::npos) << e.what();
        EXPECT_NE(std::string(e.what()).find("'exact - good'"), std::string::npos) << e.what();
    }
}

} // namespace
} // namespace study::test
