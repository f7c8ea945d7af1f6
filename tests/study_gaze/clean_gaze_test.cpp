#include "study/gaze/clean_gaze.h"
#include "study/gaze/gaze_events.h"
#include "tests/study_gaze/simulated_gaze.h"

#include <gtest/gtest.h>

namespace study::test {
namespace {

TEST(CleanGaze, CountsWhatItLeavesOut)
{
    std::vector<GazeSample> const raw{
        {0.00, 1, 2, NAN, true}, {0.01, NAN, 2, NAN, true},  {0.01, 3, 2, NAN, true}, {0.02, 0, 0, NAN, false},
        {NAN, 1, 2, NAN, true},  {0.015, 1, 2, NAN, true},   {-5.0, 1, 2, NAN, true}, {0.03, 1e8, 1e8, NAN, true},
        {0.04, 5, 6, NAN, true}, {0.05, -1100, 0, NAN, true}};
    GazeCounts c;
    auto const clean = clean_gaze(raw, kGazeScreen, c);
    ASSERT_EQ(clean.size(), 6u);
    EXPECT_EQ(c.no_time, 1);
    EXPECT_EQ(c.repeated, 1);
    EXPECT_EQ(c.backwards, 2);
    EXPECT_EQ(c.not_finite, 1);
    EXPECT_EQ(c.far_off, 1);
    std::vector<bool> valid;
    for (GazeSample const& s : clean) valid.push_back(s.is_valid);
    EXPECT_EQ(valid, (std::vector<bool>{true, false, false, false, true, true})) << "beside the screen is no error";
    GazeCounts sum;
    (sum += c) += c;
    EXPECT_EQ(sum.backwards, 4);
}

TEST(CleanGaze, TakesTheMeanOfTwoEyes)
{
    std::vector<GazeSample> left, right;
    for (int i = 0; i < 10; ++i) {
        left.push_back({0.01 * i, 10, 4, 3, i != 3});
        if (i != 6) right.push_back({0.01 * i + 0.002, 20, 8, 4, i != 3 && i != 4});
    }
    GazeCounts c;
    auto const both = mean_of_eyes(left, right, c);
    ASSERT_EQ(both.size(), 10u);
    EXPECT_EQ(c.one_eyed, 1) << "both were closed at 3";
    EXPECT_EQ(c.unpaired, 1);
    EXPECT_DOUBLE_EQ(both[0].x_px, 15);
    EXPECT_DOUBLE_EQ(both[0].y_px, 6);
    EXPECT_DOUBLE_EQ(both[0].pupil_mm, 3.5);
    EXPECT_NEAR(both[0].time_s, 0.001, 1e-12);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(both[std::size_t(i)].is_valid, i != 3 && i != 4 && i != 6) << i;
}

TEST(ValidShare, IsThatOfTime)
{
    std::vector<GazeSample> samples;
    for (int i = 0; i < 100; ++i)
        if (i < 60 || i >= 70) samples.push_back({0.01 * i, 0, 0, NAN, i < 20 || i >= 30});
    double const step = median_step_s(samples);
    EXPECT_NEAR(step, 0.01, 1e-12);
    EXPECT_NEAR(valid_share(samples, step, 0, 1), 0.8, 0.01);
    EXPECT_NEAR(valid_share(samples, step, 0, 0.4), 0.75, 0.01);
    EXPECT_NEAR(valid_share(samples, step, 0.31, 0.5), 1, 1e-9);
    EXPECT_EQ(valid_share(samples, step, 2, 3), 0) << "after the recording";
    EXPECT_EQ(valid_share({}, step, 0, 1), 0);
}

} // namespace
} // namespace study::test
