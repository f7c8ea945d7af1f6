#include "gi/core/error.h"
#include "study/signals/gaze.h"

#include <gtest/gtest.h>

namespace study::test {
namespace {

ScreenGeometry const kScreen{1920, 1080, 53.1, 29.87, 57.3, "typed"};
double px(double deg) { return px_of_place(kScreen, deg, false); }
GazeSample at(double ms, double deg, bool valid = true) { return {1e-3 * ms, px(deg), 0, 3, valid}; }

TEST(GazeWatch, CountsTheTimeInsideWithoutABreak)
{
    GazeWatch watch(kScreen, {0, 0}, 2);
    for (int ms = 0; ms <= 200; ms += 4) watch.take(at(ms, 1.9));
    EXPECT_NEAR(watch.inside_ms(), 200, 1e-6);
    watch.take(at(204, 2.1));
    EXPECT_EQ(watch.inside_ms(), 0) << "outside";
    for (int ms = 208; ms <= 308; ms += 4) watch.take(at(ms, 0));
    watch.take(at(312, 0, false));
    EXPECT_EQ(watch.inside_ms(), 0) << "a blink is no fixation";
}

TEST(GazeWatch, CountsTheTimeAwayAndBlinksAreAway)
{
    GazeWatch watch(kScreen, {px(5), 0}, 1);
    watch.take(at(0, 5));
    for (int ms = 4; ms <= 84; ms += 4) watch.take(at(ms, 5, false));
    EXPECT_NEAR(watch.away_ms(), 80, 1e-6);
    watch.take(at(88, 5.5));
    EXPECT_EQ(watch.away_ms(), 0);
    EXPECT_EQ(watch.samples(), 23);
    EXPECT_EQ(watch.valid(), 2);
    EXPECT_EQ(watch.inside(), 2);
}

TEST(GazeSamples, MissingOnesAreCounted)
{
    std::vector<GazeSample> samples;
    for (int i = 0; i < 100; ++i)
        if (i != 40 && i != 41 && i != 70) samples.push_back(at(4 * i, 0, i % 10 != 0));
    GazeSummary const s = summarise(samples);
    EXPECT_EQ(s.samples, 97);
    EXPECT_EQ(s.dropped, 3);
    EXPECT_NEAR(s.rate_hz, 250, 1e-6);
    EXPECT_EQ(s.valid, 97 - 8);
    EXPECT_EQ(summarise({}).samples, 0);
}

TEST(GazeFile, HasTimesPlacesAndValidity)
{
    auto const s = read_gaze_csv(
        "t_s,x_px,y_px,valid,pupil_mm\n0.004,640,360,1,3.1\n0.008,,,,\n0.012,641,360,0,3.2\n", "g.csv");
    ASSERT_EQ(s.size(), 3u);
    EXPECT_TRUE(s[0].is_valid);
    EXPECT_FALSE(s[1].is_valid);
    EXPECT_FALSE(s[2].is_valid);
    EXPECT_DOUBLE_EQ(s[0].pupil_mm, 3.1);
    EXPECT_TRUE(std::isnan(s[1].pupil_mm));
    for (auto const& [text, place] : {std::pair{"x,y\n1,2\n", "g.csv:1:"},
                                      {"t_s,x_px,y_px\n1,2,a\n", "g.csv:2:"},
                                      {"t_s,x_px,y_px\n,2,2\n", "g.csv:2:"},
                                      {"t_s,x_px,y_px\n1,2,2\n1,2,2\n", "g.csv:3:"}})
        try {
            read_gaze_csv(text, "g.csv");
            ADD_FAILURE() << text;
        } catch (gi::InputError const& e) {
            EXPECT_EQ(std::string(e.what()).substr(0, 8), place) << e.what();
        }
    EXPECT_THROW(read_gaze_csv("t_s,x_px,y_px\n", "g.csv"), gi::InputError);
}

} // namespace
} // namespace study::test
