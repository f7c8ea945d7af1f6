// Sickness scores against the largest that there are, and item by item.

#include "study/stats/ssq.h"

#include "tests/study_stats/support/study_data.h"

#include <cmath>

namespace study::test {
namespace {

TEST(SimulatorSickness, OfTheWorstAnswersIsTheLargestThereIs)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const e = read_json("sdt_and_constants.expected.json")["ssq_all_items_3"];
    SimulatorSickness const s = simulator_sickness(std::vector<double>(16, 3));
    EXPECT_NEAR(s.nausea, double(e["N"]), 1e-9);
    EXPECT_NEAR(s.oculomotor, double(e["O"]), 1e-9);
    EXPECT_NEAR(s.disorientation, double(e["D"]), 1e-9);
    EXPECT_NEAR(s.total, double(e["TS"]), 1e-9);
}

TEST(SimulatorSickness, CountsASymptomWhereItBelongs)
{
    std::vector<double> symptoms(16, 0);
    symptoms[0] = 1; // general discomfort: nausea and oculomotor
    SimulatorSickness const s = simulator_sickness(symptoms);
    EXPECT_NEAR(s.nausea, 9.54, 1e-12);
    EXPECT_NEAR(s.oculomotor, 7.58, 1e-12);
    EXPECT_EQ(s.disorientation, 0);
    EXPECT_NEAR(s.total, 2 * 3.74, 1e-12);
}

TEST(SimulatorSickness, RefusesOtherAnswers)
{
    EXPECT_THROW(simulator_sickness({}), std::invalid_argument);
    EXPECT_THROW(simulator_sickness(std::vector<double>(16, 4)), std::invalid_argument);
    EXPECT_THROW(simulator_sickness(std::vector<double>(16, NAN)), std::invalid_argument);
}

} // namespace
} // namespace study::test
