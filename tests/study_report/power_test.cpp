// Power by simulation, compared with the power of the t test that the simulated design has.

#include "tests/study_report/two_by_two.h"

#include <nlohmann/json.hpp>

namespace study::test {
namespace {

TEST(StudyPower, OfAMixedDesignIsThatOfItsTTest)
{
    Script const s = two_by_two();
    PowerSettings p;
    p.effects = {0, 1};
    p.participants = {12, 24};
    p.simulations = 150;
    PowerStudy const study = power_of_t_test(s, p, {0.05, 0.05, 0.3031, 0.5780});
    EXPECT_EQ(power_table(study, p).rows.size(), 4u);
    EXPECT_EQ(nlohmann::json::parse(power_json(study, p))["points"].size(), 4u);
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
