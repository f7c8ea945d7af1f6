#include "gi/core/error.h"
#include "viewer/displays/compose.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

using Bytes = std::vector<unsigned char>;

/// Every pixel encodes its eye and its place: (eye, x, y).
Bytes eye_picture(int eye, glm::ivec2 size)
{
    Bytes out;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            for (int const v : {eye, x, y}) out.push_back(static_cast<unsigned char>(v));
    return out;
}

Bytes composed(StereoMode mode, glm::ivec2 window, glm::ivec2 at = {0, 0})
{
    glm::ivec2 const eye = eye_size(mode, window);
    return compose_stereo(mode, eye_picture(10, eye), eye_picture(20, eye), window, at);
}

std::vector<int> pixel(Bytes const& bytes, int width, int x, int y)
{
    auto const i = std::ptrdiff_t(3 * (y * width + x));
    return {bytes.begin() + i, bytes.begin() + i + 3};
}

using Pixel = std::vector<int>;

TEST(Compose, OffIsTheLeftPicture)
{
    EXPECT_EQ(compose_stereo(StereoMode::off, eye_picture(10, {5, 4}), {}, {5, 4}), eye_picture(10, {5, 4}));
}

TEST(Compose, HalvesOfAnOddWindowLeaveABlackLine)
{
    Bytes const wide = composed(StereoMode::side_by_side, {7, 2});
    EXPECT_EQ(pixel(wide, 7, 2, 1), (Pixel{10, 2, 1}));
    EXPECT_EQ(pixel(wide, 7, 3, 1), (Pixel{20, 0, 1}));
    EXPECT_EQ(pixel(wide, 7, 6, 1), (Pixel{0, 0, 0}));
    Bytes const high = composed(StereoMode::top_bottom, {2, 5});
    EXPECT_EQ(pixel(high, 2, 1, 1), (Pixel{10, 1, 1}));
    EXPECT_EQ(pixel(high, 2, 1, 2), (Pixel{20, 1, 0}));
    EXPECT_EQ(pixel(high, 2, 1, 4), (Pixel{0, 0, 0}));
}

TEST(Compose, AnEyeHasAPixelWhereTheWindowHasOne)
{
    for (StereoMode const mode : {StereoMode::side_by_side, StereoMode::top_bottom}) {
        EXPECT_EQ(eye_size(mode, {1, 1}), glm::ivec2(1, 1));
        EXPECT_EQ(eye_size(mode, {0, 0}), glm::ivec2(0, 0));
        EXPECT_EQ(composed(mode, {1, 1}), (Bytes{10, 0, 0}));
    }
}

TEST(Compose, InterlacingCountsFromTheScreen)
{
    glm::ivec2 const size{6, 6};
    for (glm::ivec2 const at : {glm::ivec2{0, 0}, {1, 0}, {0, 1}, {3, 7}, {-1, -2}}) {
        Bytes const rows = composed(StereoMode::rows, size, at), columns = composed(StereoMode::columns, size, at),
                    board = composed(StereoMode::checkerboard, size, at);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                int const sx = at.x + x, sy = at.y + y;
                EXPECT_EQ(pixel(rows, 6, x, y), (Pixel{sy % 2 == 0 ? 10 : 20, x, y}));
                EXPECT_EQ(pixel(columns, 6, x, y), (Pixel{sx % 2 == 0 ? 10 : 20, x, y}));
                EXPECT_EQ(pixel(board, 6, x, y), (Pixel{(sx + sy) % 2 == 0 ? 10 : 20, x, y}));
            }
    }
}

TEST(Compose, RedCyanTakesChannels)
{
    Bytes const left{200, 1, 2}, right{3, 150, 100};
    EXPECT_EQ(compose_stereo(StereoMode::anaglyph_red_cyan, left, right, {1, 1}), (Bytes{200, 150, 100}));
}

TEST(Compose, DuboisKeepsGreyAndShowsEachEyeItsColour)
{
    auto const of = [](int l, int r) {
        Bytes const left(3, static_cast<unsigned char>(l)), right(3, static_cast<unsigned char>(r));
        return compose_stereo(StereoMode::anaglyph_dubois, left, right, {1, 1});
    };
    EXPECT_EQ(of(0, 0), (Bytes{0, 0, 0}));
    // Rows of both matrices together sum to 1.000, 0.999 and 1.000.
    EXPECT_EQ(of(255, 255), (Bytes{255, 255, 255}));
    for (int const grey : {64, 128, 200})
        for (int const v : of(grey, grey)) EXPECT_NEAR(v, grey, 1);
    EXPECT_EQ(of(255, 0), (Bytes{255, 0, 0}));
    Bytes const right = of(0, 255);
    EXPECT_EQ(right[0], 0);
    EXPECT_EQ(right[1], 255);
    EXPECT_EQ(right[2], 255);
    // Computed by hand: red in the left picture only gives 0.437 of linear red.
    Bytes const red = compose_stereo(StereoMode::anaglyph_dubois, Bytes{255, 0, 0}, Bytes{0, 0, 0}, {1, 1});
    EXPECT_EQ(red[0], 177); // 255 * (1.055 * 0.437^(1/2.4) - 0.055) = 176.52, rounded
    EXPECT_EQ(red[1], 0);
}

TEST(Compose, TwoPicturesSideBySideWhereThereIsNoSingleOne)
{
    for (StereoMode const mode : {StereoMode::quad_buffer, StereoMode::two_windows}) {
        EXPECT_EQ(composed_size(mode, {4, 3}), glm::ivec2(8, 3));
        Bytes const both = composed(mode, {4, 3});
        EXPECT_EQ(pixel(both, 8, 3, 2), (Pixel{10, 3, 2}));
        EXPECT_EQ(pixel(both, 8, 4, 2), (Pixel{20, 0, 2}));
    }
}

TEST(Compose, RefusesPicturesOfAnotherSize)
{
    Bytes const small(3), right(12);
    EXPECT_THROW(compose_stereo(StereoMode::rows, small, right, {2, 2}), gi::InputError);
    EXPECT_THROW(compose_stereo(StereoMode::rows, right, small, {2, 2}), gi::InputError);
}

} // namespace
} // namespace viewer::test
