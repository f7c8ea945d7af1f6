// Whether a PNG shows what its picture holds.

#include "gi/filter/tone_map.h"
#include "viewer/offline/shown_range.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

/// Of a grey picture, a share of whose pixels has this radiance; the others 0.2.
std::string problem_of(float radiance, double share, float exposure_ev = 0)
{
    gi::Layer color{"color", 3, {}};
    for (int i = 0; i < 1000; ++i) color.data.insert(color.data.end(), 3, i < 1000 * share ? radiance : 0.2f);
    ShownRange range;
    range.add(color, gi::tone_map_bytes(color, {.exposure_ev = exposure_ev}));
    return range.problem("a.png", exposure_ev);
}

TEST(ShownRange, WhatIsMostlyShownIsFine)
{
    EXPECT_EQ(problem_of(0.5f, 1), "");
    EXPECT_EQ(problem_of(50, 0.5), ""); // a window with a sky
    EXPECT_EQ(problem_of(0, 0.9), "");  // a lamp in the dark
}

TEST(ShownRange, SaysWhichExposureShowsIt)
{
    // 2^-8 of 0.18 * 2^8 is 0.18.
    EXPECT_NE(problem_of(0.18f * 256, 0.9).find("90 % of 'a.png' is white"), std::string::npos);
    EXPECT_NE(problem_of(0.18f * 256, 0.9).find("--exposure -8.0 shows"), std::string::npos);
    EXPECT_EQ(problem_of(0.18f * 256, 0.9, -8), "");
    EXPECT_NE(problem_of(0.18f / 4096, 1, -4).find("--exposure 12.0 shows"), std::string::npos);
    for (float const nothing : {0.0f, 1e-9f})
        EXPECT_NE(problem_of(nothing, 1).find("no light reaches"), std::string::npos);
}

} // namespace
} // namespace viewer::test
