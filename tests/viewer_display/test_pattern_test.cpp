// Pictures for setting up: their size, their colours where they matter, and the two eyes' difference.

#include "tests/viewer_display/display_samples.h"
#include "viewer/displays/blend.h"
#include "viewer/displays/test_pattern.h"

#include <array>

namespace viewer::test {
namespace {

using Rgb = std::array<int, 3>;

Rgb pixel(PatternPicture const& p, double u, double v)
{
    int const x = std::min(p.width - 1, int(u * p.width)), y = std::min(p.height - 1, int((1 - v) * p.height));
    unsigned char const* at = p.rgb.data() + 3 * (std::size_t(y) * std::size_t(p.width) + std::size_t(x));
    return {at[0], at[1], at[2]};
}

TEST(Calibration, EveryPatternOfEveryViewHasItsSize)
{
    for (char const* file : {"cave4.yaml", "dome.yaml", "desktop3d.yaml"}) {
        Display const d = shipped(file);
        for (DisplayView const& view : views_of(d, {}))
            for (TestPattern const pattern : kTestPatterns) {
                PatternPicture const picture = draw_pattern(pattern, d, view);
                EXPECT_EQ(picture.width, view.width_px);
                EXPECT_EQ(picture.height, view.height_px);
                ASSERT_EQ(picture.rgb.size(), std::size_t(view.width_px) * std::size_t(view.height_px) * 3);
                EXPECT_EQ(test_pattern(name_of(pattern)), pattern);
            }
    }
}

TEST(Calibration, TinyPicturesAndDarkEyesAreDrawnToo)
{
    Display d = shipped("cave4.yaml");
    d.users[0].head.translation_m = {0, 1.7, -5};
    for (DisplayView view : views_of(d, {}))
        for (TestPattern const pattern : kTestPatterns) {
            view.width_px = 1;
            view.height_px = 3;
            EXPECT_EQ(draw_pattern(pattern, d, view).rgb.size(), 9u);
        }
}

TEST(Calibration, CornersHaveTheirColours)
{
    Display const d = shipped("cave4.yaml");
    auto const p = draw_pattern(TestPattern::corners, d, views_of(d, {})[2]);
    EXPECT_EQ(pixel(p, 0.05, 0.05), (Rgb{255, 0, 0}));
    EXPECT_EQ(pixel(p, 0.95, 0.05), (Rgb{0, 200, 0}));
    EXPECT_EQ(pixel(p, 0.05, 0.95), (Rgb{60, 90, 255}));
    EXPECT_EQ(pixel(p, 0.95, 0.95), (Rgb{240, 220, 0}));
}

TEST(Calibration, CrosstalkFieldsAreForOneEye)
{
    Display const d = shipped("cave4.yaml");
    auto const views = views_of(d, {});
    auto const left = draw_pattern(TestPattern::crosstalk, d, views[0]),
               right = draw_pattern(TestPattern::crosstalk, d, views[1]);
    int combinations = 0;
    for (double const u : {0.25, 0.75})
        for (double const v : {0.3, 0.7})
            combinations |= 1 << (2 * (pixel(left, u, v)[0] > 127) + (pixel(right, u, v)[0] > 127));
    EXPECT_EQ(combinations, 15); // each of black/white with each
}

TEST(Calibration, MarksOfTheEyesAreWhereGeometryPutsThem)
{
    Display const d = shipped("cave4.yaml");
    auto const views = views_of(d, {});
    auto const middle_of_cross = [&](int view, double v) {
        auto const p = draw_pattern(TestPattern::eyes, d, views[std::size_t(view)]);
        Rgb const mine = views[std::size_t(view)].eye == Eye::left ? Rgb{255, 0, 0} : Rgb{0, 230, 230};
        int first = -1, last = -1; // of the vertical bar, a little above the middle
        for (int x = 0; x < p.width; ++x)
            if (double const u = (x + 0.5) / p.width; u > 0.46 && u < 0.54 && pixel(p, u, v + 0.008) == mine) {
                if (first < 0) first = x;
                last = x;
            }
        return (0.5 * (first + last) + 0.5) / p.width;
    };
    double const width = 3;
    // Front wall: on it no disparity, half way to the eyes minus their distance, at infinity their distance.
    auto const disparity_m = [&](double v) { return width * (middle_of_cross(3, v) - middle_of_cross(2, v)); };
    double const px = width / 1024;
    EXPECT_NEAR(disparity_m(0.4), 0, 1e-9);
    EXPECT_NEAR(disparity_m(0.55), -0.063, 1.01 * px);
    EXPECT_NEAR(disparity_m(0.1), 0.063, 1.01 * px);
}

TEST(Calibration, BlendedWhiteAddsUp)
{
    Display const d = shipped("powerwall.yaml");
    auto const views = views_of(d, {});
    auto const a = draw_pattern(TestPattern::blend, d, views[0]); // lower left, left eye
    auto const b = draw_pattern(TestPattern::blend, d, views[2]); // lower middle
    for (int i = 1; i < 96 * 2; ++i) {                            // 0.2 of 2 m are 192 of 1920 pixels
        double const x = (i + 0.5) / 1920;
        double const light =
            std::pow(pixel(a, 1 - 0.1 + x, 0.3)[0] / 255.0, 2.2) + std::pow(pixel(b, x, 0.3)[0] / 255.0, 2.2);
        EXPECT_NEAR(light, 1, 0.011) << i;
    }
}

TEST(Calibration, GridStepsAreRound)
{
    auto const step = [](double width, double height) {
        WallFrame frame;
        frame.width_m = width;
        frame.height_m = height;
        return grid_step_m(frame);
    };
    EXPECT_NEAR(step(3, 3), 0.2, 1e-12);
    EXPECT_NEAR(step(0.6, 0.3), 0.05, 1e-12);
    EXPECT_NEAR(step(1000, 10), 50, 1e-9);
    EXPECT_NEAR(step(1e-3, 1e-3), 5e-5, 1e-15);
}

} // namespace
} // namespace viewer::test
