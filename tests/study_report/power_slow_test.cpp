// Power of more numbers of participants and effects, by more simulations.

#include "tests/study_report/two_by_two.h"

namespace study::test {
namespace {

TEST(StudyPowerSlow, OfAMixedDesignIsThatOfItsTTest)
{
    PowerSettings p;
    p.effects = {0, 0.5, 1};
    p.participants = {12, 24, 40};
    p.simulations = 400;
    power_of_t_test(two_by_two(), p, {0.05, 0.05, 0.05, 0.1118, 0.1904, 0.2948, 0.3031, 0.5780, 0.8100});
}

} // namespace
} // namespace study::test
