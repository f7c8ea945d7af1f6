#include "viewer/xr/visibility.h"

#include <gtest/gtest.h>
#include <numeric>

namespace viewer::test {
namespace {

int count(std::vector<std::uint8_t> const& pixels) { return std::accumulate(pixels.begin(), pixels.end(), 0); }

TEST(HiddenPixels, NoneWithoutTriangles) { EXPECT_EQ(count(hidden_pixels({}, {-1, 1, -1, 1}, 8, 6)), 0); }

/// The upper left half of an asymmetric view, either way round.
TEST(HiddenPixels, CoversMiddlesInTheTriangle)
{
    gi::ViewTangents const view{-2, 1, -1, 0.5};
    for (std::vector<std::uint32_t> const& order : {std::vector<std::uint32_t>{0, 1, 2}, {0, 2, 1}}) {
        HiddenMask const mask{{{-2, 0.5f}, {-2, -1}, {1, 0.5f}}, order, 1};
        auto const hidden = hidden_pixels(mask, view, 30, 15);
        for (int y = 0; y < 15; ++y)
            for (int x = 0; x < 30; ++x) {
                double const sum = (x + 0.5) / 30 + (y + 0.5) / 15;
                if (std::abs(sum - 1) < 1e-6) continue; // on the edge
                EXPECT_EQ(hidden[std::size_t(y * 30 + x)], sum < 1) << x << ' ' << y;
            }
    }
}

TEST(HiddenPixels, ReachesPastThePicture)
{
    HiddenMask const mask{{{-100, 100}, {-100, -300}, {300, 100}}, {0, 1, 2}, 1};
    EXPECT_EQ(count(hidden_pixels(mask, {-1, 1, -1, 1}, 7, 5)), 35);
}

TEST(HiddenPixels, TrianglesThatAreNoneAreLeftOut)
{
    float const nan = std::nanf("");
    HiddenMask const mask{{{-1, -1}, {1, 1}, {nan, 0}}, {0, 1, 7, 0, 1, 2, 0, 1, 1, 0}, 1};
    EXPECT_EQ(count(hidden_pixels(mask, {-1, 1, -1, 1}, 8, 8)), 0);
}

} // namespace
} // namespace viewer::test
