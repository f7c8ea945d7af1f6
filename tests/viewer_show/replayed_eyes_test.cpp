// Which pictures of a recorded walk a replay writes, their sizes, and how they are put together.

#include "viewer/app/replayed_picture.h"
#include "viewer/displays/compose.h"
#include "viewer/displays/desktop_views.h"

#include <gtest/gtest.h>
#include <numeric>

namespace viewer::test {
namespace {

/// The views of a window, as the viewer orders them.
FrameCommand window(StereoMode mode, glm::ivec2 px)
{
    FrameCommand c;
    DesktopStereo const stereo{mode != StereoMode::off, 0.063, 2};
    c.views = desktop_views(gi::look_at({0, 1, 3}, {0, 1, 0}, 60), stereo, px, eye_size(mode, px));
    return c;
}

TEST(ReplayedEyes, AWindowHasItsOwnSizeInEveryMode)
{
    for (StereoMode const mode : kStereoModes)
        for (glm::ivec2 const px : {glm::ivec2(320, 120), glm::ivec2(321, 121), glm::ivec2(100, 400)}) {
            SCOPED_TRACE(std::string(name_of(mode)) + " " + std::to_string(px.x));
            RecordedViews const v = recorded_views(window(mode, px));
            Arrangement const a = arrange(v, ReplayedEyes::window, mode);
            EXPECT_EQ(a.size_px, composed_size(mode, px));
            EXPECT_EQ(a.mode == StereoMode::off, mode == StereoMode::off);
            EXPECT_EQ(v.right, mode == StereoMode::off ? -1 : 1);
            EXPECT_EQ(eye_size(a.mode, a.size_px), eye_size(mode, px));
        }
}

TEST(ReplayedEyes, OneEyeOrBothAsTheyWereRendered)
{
    RecordedViews const v = recorded_views(window(StereoMode::side_by_side, {320, 120}));
    Arrangement const left = arrange(v, ReplayedEyes::left, StereoMode::side_by_side),
                      right = arrange(v, ReplayedEyes::right, StereoMode::side_by_side),
                      both = arrange(v, ReplayedEyes::both, StereoMode::anaglyph_dubois);
    EXPECT_EQ(left.left, 0);
    EXPECT_EQ(right.left, 1);
    EXPECT_EQ(left.mode, StereoMode::off);
    EXPECT_EQ(right.size_px, glm::ivec2(160, 120));
    EXPECT_EQ(both.mode, StereoMode::side_by_side);
    EXPECT_EQ(both.size_px, glm::ivec2(320, 120));
}

/// Without quad buffers the window is shared, which the pixels of its views tell.
TEST(ReplayedEyes, WindowsWithoutQuadBuffersWereShared)
{
    RecordedViews const shared = recorded_views(window(StereoMode::side_by_side, {320, 120}));
    EXPECT_EQ(arrange(shared, ReplayedEyes::window, StereoMode::quad_buffer).size_px, glm::ivec2(320, 120));
    RecordedViews const whole = recorded_views(window(StereoMode::quad_buffer, {320, 120}));
    EXPECT_EQ(arrange(whole, ReplayedEyes::window, StereoMode::quad_buffer).size_px, glm::ivec2(640, 120));
}

/// A mode that changed before the views of its window did.
TEST(ReplayedEyes, AModeThatJustChangedKeepsTheWindow)
{
    glm::ivec2 const px(320, 120);
    for (StereoMode const rendered : {StereoMode::side_by_side, StereoMode::top_bottom, StereoMode::rows})
        for (StereoMode const mode : {StereoMode::off, StereoMode::side_by_side, StereoMode::top_bottom,
                                      StereoMode::anaglyph_dubois, StereoMode::checkerboard})
            EXPECT_EQ(arrange(recorded_views(window(rendered, px)), ReplayedEyes::window, mode).size_px, px);
}

TEST(ReplayedEyes, OfWallsTheFirstWithItsOtherEye)
{
    FrameCommand c = window(StereoMode::side_by_side, {320, 120});
    c.views[0].name = "front, right eye"; // the eyes of a display are exchanged
    c.views[1].name = "front, left eye";
    c.views.insert(c.views.begin() + 1, {"floor", c.views[0].camera, 50, 50, -1});
    RecordedViews const v = recorded_views(c);
    EXPECT_TRUE(v.is_wall);
    EXPECT_EQ(v.left, 2);
    EXPECT_EQ(v.right, 0);
    EXPECT_EQ(arrange(v, ReplayedEyes::window, StereoMode::side_by_side).mode, StereoMode::off);
}

TEST(ReplayedEyes, SizesKeepTheAspect)
{
    EXPECT_EQ(fitted(2, {320, 160}), glm::ivec2(320, 160));
    EXPECT_EQ(fitted(2, {321, 160}), glm::ivec2(321, 160)); // rounded
    EXPECT_EQ(fitted(2, {160, 120}), glm::ivec2(160, 80));
    EXPECT_EQ(fitted(2, {400, 100}), glm::ivec2(200, 100));
    EXPECT_EQ(fitted(4.0 / 3, {5, 4}), glm::ivec2(5, 4));
    RecordedViews const v = recorded_views(window(StereoMode::side_by_side, {320, 120}));
    auto const is_square = [&](ReplayedEyes eyes, glm::ivec2 size) {
        return shows_square_pixels(v, eyes, arrange(v, eyes, StereoMode::side_by_side), size);
    };
    EXPECT_FALSE(is_square(ReplayedEyes::left, {160, 120}));
    EXPECT_TRUE(is_square(ReplayedEyes::left, {320, 120}));
    EXPECT_FALSE(is_square(ReplayedEyes::window, {320, 120}));
    EXPECT_TRUE(is_square(ReplayedEyes::both, {640, 120}));
}

gi::Picture numbered(glm::ivec2 size, float first)
{
    gi::Picture p{size.x, size.y, {}, {}};
    std::vector<float>& color = p.add("color", 3).data;
    std::iota(color.begin(), color.end(), first);
    p.add("depth", 1).data.assign(p.pixels(), first);
    return p;
}

/// Linear pictures are put together as compose_stereo() does with bytes.
TEST(ReplayedEyes, LinearPicturesAreComposedAsBytesAre)
{
    glm::ivec2 const px(6, 4);
    for (StereoMode const mode : {StereoMode::off, StereoMode::side_by_side, StereoMode::top_bottom,
                                  StereoMode::rows, StereoMode::columns, StereoMode::checkerboard}) {
        SCOPED_TRACE(name_of(mode));
        glm::ivec2 const eye = eye_size(mode, px);
        gi::Picture const left = numbered(eye, 0), right = numbered(eye, 100);
        auto const bytes = [](gi::Picture const& p) {
            std::vector<float> const& data = p.find("color")->data;
            return std::vector<unsigned char>(data.begin(), data.end());
        };
        gi::Picture const whole = composed({mode, 0, 1, px}, left, right);
        EXPECT_EQ(bytes(whole), compose_stereo(mode, bytes(left), bytes(right), px));
        EXPECT_EQ(whole.find("depth")->data.size(), std::size_t(px.x * px.y));
    }
}

TEST(ReplayedEyes, PicturesOfAnotherAspectStandInBlack)
{
    std::vector<unsigned char> const white(3 * 4 * 2, 255);
    std::vector<unsigned char> const placed = on_canvas(white, {4, 2}, {4, 4});
    std::vector<unsigned char> expected(3 * 4 * 4);
    std::fill_n(expected.begin() + 12, 24, 255);
    EXPECT_EQ(placed, expected);
    gi::Picture one = numbered({4, 2}, 1);
    gi::Picture const tall = on_canvas(one, {4, 4});
    EXPECT_EQ(tall.find("depth")->data, (std::vector<float>{0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0}));
}

} // namespace
} // namespace viewer::test
