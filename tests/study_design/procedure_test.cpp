// Where staircases settle, and grids of levels.

#include "tests/study_design/samples.h"

#include <cmath>

namespace study::test {
namespace {

Procedure staircase(int up, int down)
{
    Procedure p;
    p.method = Method::staircase;
    p.up = up;
    p.down = down;
    return p;
}

TEST(Staircase, SettlesWhereLevittSays)
{
    EXPECT_NEAR(settles_at(staircase(1, 1)), 0.5, 1e-9);
    EXPECT_NEAR(settles_at(staircase(1, 2)), std::sqrt(0.5), 1e-9);
    EXPECT_NEAR(settles_at(staircase(1, 3)), std::cbrt(0.5), 1e-9);
    EXPECT_NEAR(settles_at(staircase(2, 1)), 1 - std::sqrt(0.5), 1e-9);
    EXPECT_NEAR(settles_at(staircase(1, 4)), std::pow(0.5, 0.25), 1e-9);
    EXPECT_NEAR(settles_at(staircase(3, 3)), 0.5, 1e-9);
    Procedure weighted = staircase(1, 1);
    weighted.target = 0.75;
    EXPECT_EQ(settles_at(weighted), 0.75);
}

Script with_procedure(std::string const& procedure, std::string const& scale = "log2")
{
    return parse("factors: {q: {best: {paths: 4096}}}\nreference: {q: best}\n"
                 "defaults: {stimulus_ms: 1000}\nsequence: [b]\nblocks:\n  b:\n    task: 2ifc\n"
                 "    compare: {vary: paths, scale: " +
                 scale + ", range: [1, 1024], harder: up}\n    procedure: " + procedure + "\n");
}

TEST(Grids, AreEvenOnTheScale)
{
    auto const levels = [](std::string const& grid, std::string const& scale) {
        return with_procedure("{method: constant, levels: " + grid + "}", scale).blocks[0].procedures[0].levels;
    };
    std::vector<double> const octaves = levels("1..1024/11", "log2");
    ASSERT_EQ(octaves.size(), 11u);
    for (std::size_t i = 0; i < 11; ++i) EXPECT_NEAR(octaves[i], std::exp2(double(i)), 1e-9);
    EXPECT_EQ(levels("1..5/5", "linear"), (std::vector<double>{1, 2, 3, 4, 5}));
    std::vector<double> const decades = levels("1..1000/4", "db");
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(decades[i], std::pow(10, double(i)), 1e-9);
    EXPECT_EQ(levels("[3, 7.5]", "log10"), (std::vector<double>{3, 7.5}));
    EXPECT_EQ(levels("12", "log10"), (std::vector<double>{12}));
}

TEST(QuestPlus, HasTheGridsOfItsPrior)
{
    Procedure const p =
        with_procedure("{method: questplus, threshold: 64..1024/33, slope: [1, 2, 3.5, 5], guess: 0.5, "
                       "lapse: [0, 0.02, 0.04], stop: {trials: 25}}")
            .blocks[0]
            .procedures[0];
    EXPECT_EQ(p.threshold.size(), 33u);
    EXPECT_EQ(p.stimuli, p.threshold);
    EXPECT_EQ(p.slope, (std::vector<double>{1, 2, 3.5, 5}));
    EXPECT_EQ(p.guess, (std::vector<double>{0.5}));
    EXPECT_EQ(planned_trials(p), 25);
    EXPECT_EQ(assumed_function(p).function, Psychometric::weibull);
}

} // namespace
} // namespace study::test
