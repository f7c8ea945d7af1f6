#include "study/display/geometry.h"

#include <gtest/gtest.h>

namespace study::test {
namespace {

/// At 57.3 cm, a centimetre is a degree.
ScreenGeometry const kScreen{1920, 1080, 53.1, 29.87, 57.2958, "typed"};

TEST(ScreenGeometry, ACentimetreIsADegreeAt57Centimetres)
{
    EXPECT_NEAR(pixels_per_degree(kScreen), 1920 / 53.1, 1e-3);
    EXPECT_NEAR(px_of_size(kScreen, 1, false), 1920 / 53.1, 0.01);
    EXPECT_NEAR(px_of_size(kScreen, 90, false), 2 * 57.2958 * 1920 / 53.1, 0.01) << "2 d tan 45";
}

TEST(ScreenGeometry, PlacesAndDegreesUndoEachOther)
{
    for (double const deg : {-20.0, -3.0, 0.0, 0.5, 12.0, 24.0})
        for (bool const down : {false, true})
            EXPECT_NEAR(deg_of_place(kScreen, px_of_place(kScreen, deg, down), down), deg, 1e-12);
}

TEST(ScreenGeometry, AnglesBetweenPlacesAreThoseOfTheirDirections)
{
    auto const right = px_of_place(kScreen, 10, false), left = px_of_place(kScreen, -10, false);
    EXPECT_NEAR(deg_between(kScreen, {left, 0}, {right, 0}), 20, 1e-9);
    EXPECT_NEAR(deg_between(kScreen, {right, 0}, {right, 0}), 0, 1e-12);
    // A pixel far to the side is a smaller angle than one in the middle.
    EXPECT_LT(deg_between(kScreen, {right, 0}, {right + 1, 0}), deg_between(kScreen, {0, 0}, {1, 0}));
}

TEST(ScreenGeometry, WithoutADistanceThereAreNoDegrees)
{
    ScreenGeometry s = kScreen;
    s.distance_cm = 0;
    EXPECT_TRUE(std::isnan(pixels_per_degree(s)));
}

} // namespace
} // namespace study::test
