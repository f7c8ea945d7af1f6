// What is on a real window, in every stereo mode.

#include "tests/viewer_gl/on_xvfb.h"
#include "tests/viewer_gl/stereo_check.h"

#include <epoxy/gl.h>

namespace viewer::test {
namespace {

using StereoOnX = OnXvfb;

WindowSettings settings_of(glm::ivec2 size, glm::ivec2 position)
{
    WindowSettings settings;
    settings.size_px = size;
    settings.position_px = position;
    settings.swap_interval = 0;
    return settings;
}

TEST_F(StereoOnX, AllModesAreThoseOfTheCpu)
{
    for (glm::ivec2 const position : {glm::ivec2{0, 0}, {11, 7}, {8, 13}}) {
        Window window(settings_of({321, 240}, position), report);
        poll_windows();
        ASSERT_EQ(window.position_px(), position);
        check_all_modes(target_of(window), window.position_px(), "window_" + std::to_string(position.x));
    }
}

/// The X server's own picture of its screen agrees: what is read back is what is shown.
TEST_F(StereoOnX, RowsAreWhereTheScreenHasThem)
{
    if (gi::test::run_shell("import -version > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "SKIPPED: there is no import";
    glm::ivec2 const size{64, 48};
    Window window(settings_of(size, {21, 33}), report);
    poll_windows();
    PictureTexture white, black;
    white.upload(size, std::vector<float>(3 * 64 * 48, 1.0f));
    black.upload(size, std::vector<float>(3 * 64 * 48, 0.0f));
    DisplayPass pass;
    DisplaySettings settings;
    settings.stereo = StereoMode::rows;
    settings.on_screen_px = window.position_px();
    pass.draw(target_of(window), {white.shown(), {}}, {black.shown(), {}}, settings);
    window.swap();
    glFinish();
    std::string const file = "/tmp/lightwell_rows_" + std::to_string(getpid()) + ".png";
    ASSERT_EQ(gi::test::run_shell("import -window root " + file), 0);
    gi::Picture const screen = gi::read_picture(file);
    std::remove(file.c_str());
    ASSERT_EQ(screen.width, 800);
    gi::Layer const& color = screen.layers.at(0);
    for (int y = 33; y < 33 + size.y; ++y)
        for (int x = 21; x < 21 + size.x; ++x)
            EXPECT_EQ(gi::rgb(color, std::size_t(y * 800 + x)).x, y % 2 == 0 ? 1.0f : 0.0f) << x << ", " << y;
}

TEST_F(StereoOnX, TwoWindowsShowAnEyeEach)
{
    glm::ivec2 const size{80, 60};
    Window left_window(settings_of(size, {0, 0}), report);
    Eyes const eyes(size, 4.0 / 3);
    DisplayPass left_pass;
    DisplaySettings settings;
    auto const expected_left = eye_bytes(left_pass, eyes.left, settings);
    auto const expected_right = eye_bytes(left_pass, eyes.right, settings);
    glFinish();
    Window right_window(settings_of(size, {100, 0}), report, &left_window);
    settings.stereo = StereoMode::two_windows;
    {
        DisplayPass right_pass;
        right_pass.draw(target_of(right_window), {eyes.right.shown(), {}}, {}, settings);
        EXPECT_EQ(read_bytes(target_of(right_window)), expected_right);
    }
    left_window.gl().make_current();
    left_pass.draw(target_of(left_window), {eyes.left.shown(), {}}, {}, settings);
    EXPECT_EQ(read_bytes(target_of(left_window)), expected_left);
}

TEST_F(StereoOnX, QuadBufferFallsBackToSideBySide)
{
    WindowSettings wanted = settings_of({64, 48}, {0, 0});
    wanted.quad_buffer = QuadBuffer::wanted;
    Window window(wanted, report);
    StereoMode const mode = mode_on(target_of(window), StereoMode::quad_buffer);
    EXPECT_EQ(mode, window.has_quad_buffer() ? StereoMode::quad_buffer : StereoMode::side_by_side);
}

} // namespace
} // namespace viewer::test
