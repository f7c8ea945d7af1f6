// Answers that a step explains: any threshold within its gap fits.

#include "study/stats/step_gap.h"

#include <gtest/gtest.h>

namespace study::test {
namespace {

/// The gap of answers of 20 trials at levels 1, 2, 3, ...; {0, 0} = none.
StepGap gap_of(std::vector<double> const& correct, double guess, double unit = 1,
               Direction direction = Direction::rising)
{
    std::vector<LevelCount> counts;
    for (std::size_t i = 0; i < correct.size(); ++i) counts.push_back({unit * double(i + 1), correct[i], 20});
    PsychometricShape shape;
    shape.direction = direction;
    StepRates rates;
    if (guess >= 0) rates.guess = guess;
    return step_gap(counts, shape, rates).value_or(StepGap{});
}

TEST(StepGap, LiesBetweenTheLevelsOfAStep)
{
    StepGap const between{2, 3}, none{};
    EXPECT_EQ(gap_of({0, 0, 20, 20, 20}, 0), between);
    EXPECT_EQ(gap_of({10, 10, 20, 20, 20}, 0.5), between);
    EXPECT_EQ(gap_of({9, 11, 20, 20, 20}, 0.5), between) << "chance";
    EXPECT_EQ(gap_of({5, 4, 20, 20}, 0.5), between) << "below chance";
    EXPECT_EQ(gap_of({1, 1, 20, 20}, 0.05), between) << "false alarms";
    EXPECT_EQ(gap_of({3, 3, 20, 20}, -1), between) << "a guess rate that is fitted";
    EXPECT_EQ(gap_of({0, 0, 19, 20, 19}, 0), between) << "lapses";
    EXPECT_EQ(gap_of({20, 20, 0, 0}, 0, 1, Direction::falling), between);
    EXPECT_EQ(gap_of({0, 20}, 0), (StepGap{1, 2}));
    EXPECT_EQ(gap_of({0, 0, 20, 20}, 0, 1e-12), (StepGap{2e-12, 3e-12}));
    EXPECT_EQ(gap_of({0, 3, 20, 20}, 0), none);
    EXPECT_EQ(gap_of({10, 15, 20, 20}, 0.5), none);
    EXPECT_EQ(gap_of({0, 5, 10, 15, 20}, 0), none);
    EXPECT_EQ(gap_of({20, 20, 20}, 0.5), none);
    EXPECT_EQ(gap_of({0, 0, 0}, 0), none);
    EXPECT_EQ(gap_of({20, 20, 0, 0}, 0), none) << "the wrong direction";
    EXPECT_EQ(gap_of({12}, 0.5), none);
}

TEST(StepGap, IsNamedByFitsAndWithinIntervals)
{
    std::vector<LevelCount> const counts{{1, 0, 20}, {2, 0, 20}, {3, 20, 20}, {4, 20, 20}};
    EXPECT_NE(fit_psychometric(counts, {}).note.find("any threshold between 2 and 3 fits"), std::string::npos)
        << fit_psychometric(counts, {}).note;
    PsychometricShape shape;
    Interval i{2.2, 2.8};
    include_gap({2, 3}, shape, i);
    EXPECT_EQ(i.low, 2);
    EXPECT_EQ(i.high, 3);
    shape.direction = Direction::falling;
    i = {-2.8, -2.2};
    include_gap({2, 3}, shape, i);
    EXPECT_EQ(i.low, -3);
}

} // namespace
} // namespace study::test
