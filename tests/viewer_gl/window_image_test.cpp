// Real windows on a real X server, real keys.

#include "tests/viewer_gl/on_xvfb.h"
#include "tests/viewer_gl/stereo_check.h"
#include "viewer/devices/gl/glfw_library.h"
#include "viewer/devices/gl/panel.h"

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <imgui.h>

namespace viewer::test {
namespace {

using WindowOnX = OnXvfb;

WindowSettings window_settings(glm::ivec2 size, glm::ivec2 position)
{
    WindowSettings settings;
    settings.size_px = size;
    settings.position_px = position;
    settings.swap_interval = 0;
    return settings;
}

/// Polls until an event fits, for at most 5 s.
template <class Fits>
std::optional<InputEvent> await(Window& window, Fits const& fits)
{
    auto const end = InputEvent::Clock::now() + std::chrono::seconds(5);
    while (InputEvent::Clock::now() < end) {
        wait_for_windows(0.05);
        for (InputEvent const& e : window.take_events())
            if (fits(e)) return e;
    }
    return {};
}

void inject(std::string const& xdotool) { ASSERT_EQ(gi::test::run_shell("xdotool " + xdotool), 0); }
bool have_xdotool() { return gi::test::run_shell("xdotool version > /dev/null 2>&1") == 0; }

TEST_F(WindowOnX, SaysThatTheDriverHasNoSwapGroups)
{
    WindowSettings settings = window_settings({64, 48}, {10, 10});
    settings.borders = false;
    settings.swap_group = settings.swap_barrier = 1;
    Window const window(settings, report);
    auto const losses = report.losses();
    auto const loss = losses.find("windows outside their swap group, which swap by themselves");
    if (loss == losses.end()) GTEST_SKIP() << "SKIPPED: this driver has swap groups";
    EXPECT_EQ(loss->second.first, "lightwell: the driver has no GLX_NV_swap_group");
    EXPECT_EQ(glfwGetWindowAttrib(window.glfw(), GLFW_DECORATED), 0);
}

TEST_F(WindowOnX, HasOpenGl45AndTheSizeAskedFor)
{
    Window window(window_settings({320, 240}, {10, 20}), report);
    EXPECT_EQ(window.framebuffer_px(), glm::ivec2(320, 240));
    poll_windows();
    EXPECT_EQ(window.position_px(), glm::ivec2(10, 20));
    EXPECT_NE(window.gl().glx().display, nullptr);
    EXPECT_NE(window.gl().glx().config, nullptr);
    EXPECT_NE(window.gl().glx().visual, 0u);
    EXPECT_EQ(window.gl().egl().context, nullptr);
    EXPECT_FALSE(window.wants_close());
    RecordProperty("context", window.gl().description());
}

TEST_F(WindowOnX, KeysMouseAndResizeArriveAsEvents)
{
    if (!have_xdotool()) GTEST_SKIP() << "SKIPPED: there is no xdotool";
    Window window(window_settings({320, 240}, {0, 0}), report);
    window.swap();
    poll_windows();
    glfwFocusWindow(window.glfw());
    inject("mousemove 100 50");
    auto const moved = await(window, [](InputEvent const& e) { return e.kind == InputKind::mouse_move; });
    ASSERT_TRUE(moved);
    EXPECT_EQ(moved->x, 100);
    EXPECT_EQ(moved->y, 50);
    auto const before = InputEvent::Clock::now();
    inject("key w");
    auto const key = await(window, [](InputEvent const& e) { return e.kind == InputKind::key; });
    ASSERT_TRUE(key);
    EXPECT_EQ(key->code, GLFW_KEY_W);
    EXPECT_EQ(key->action, InputAction::press);
    EXPECT_EQ(key->window, window.number());
    EXPECT_GE(key->time, before);
    inject("key shift+q");
    auto const character =
        await(window, [](InputEvent const& e) { return e.kind == InputKind::character && e.code == 'Q'; });
    EXPECT_TRUE(character);
    inject("click 3");
    auto const click = await(window, [](InputEvent const& e) { return e.kind == InputKind::mouse_button; });
    ASSERT_TRUE(click);
    EXPECT_EQ(click->code, GLFW_MOUSE_BUTTON_RIGHT);
    EXPECT_EQ(click->x, 100);
    inject("click 4");
    auto const scroll = await(window, [](InputEvent const& e) { return e.kind == InputKind::scroll; });
    ASSERT_TRUE(scroll);
    EXPECT_EQ(scroll->y, 1);
    inject("search --name lightwell windowsize 400 300");
    auto const resized = await(window, [](InputEvent const& e) { return e.kind == InputKind::resize; });
    ASSERT_TRUE(resized);
    EXPECT_EQ(resized->x, 400);
    EXPECT_EQ(resized->y, 300);
    inject("search --name lightwell windowmove 33 44");
    auto const placed = await(window, [](InputEvent const& e) { return e.kind == InputKind::move; });
    ASSERT_TRUE(placed);
    EXPECT_EQ(window.position_px(), glm::ivec2(33, 44));
}

TEST_F(WindowOnX, FocusArrivesAsEvents)
{
    if (!have_xdotool()) GTEST_SKIP() << "SKIPPED: there is no xdotool";
    Window window(window_settings({320, 240}, {0, 0}), report);
    Window const other(window_settings({64, 64}, {400, 0}), report);
    window.set_title("first of two");
    inject("search --sync --name 'first of two' windowfocus");
    auto const gained = [](InputEvent const& e) {
        return e.kind == InputKind::focus && e.action == InputAction::press;
    };
    EXPECT_TRUE(await(window, gained));
    glfwFocusWindow(other.glfw());
    EXPECT_TRUE(await(window, [](InputEvent const& e) {
        return e.kind == InputKind::focus && e.action == InputAction::release;
    }));
}

TEST_F(WindowOnX, FullScreenFillsItsMonitor)
{
    auto const all = monitors();
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].size_px, glm::ivec2(800, 600));
    WindowSettings settings;
    settings.monitor = all[0].name;
    Window window(settings, report);
    poll_windows();
    EXPECT_EQ(window.framebuffer_px(), glm::ivec2(800, 600));
    EXPECT_EQ(window.position_px(), glm::ivec2(0, 0));
}

TEST_F(WindowOnX, UnknownMonitorIsNamedWithThoseThatAre)
{
    WindowSettings settings;
    settings.monitor = "HDMI-7";
    try {
        Window const window(settings, report);
        FAIL();
    } catch (gi::InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("HDMI-7"), std::string::npos);
        EXPECT_NE(std::string(e.what()).find("0 ("), std::string::npos) << e.what();
    }
}

TEST_F(WindowOnX, QuadBufferFallsBackAndSaysSo)
{
    WindowSettings settings = window_settings({64, 64}, {0, 0});
    settings.quad_buffer = QuadBuffer::wanted;
    Window const window(settings, report);
    if (window.has_quad_buffer()) GTEST_SKIP() << "SKIPPED: this driver has quad-buffer stereo";
    auto const losses = report.losses();
    ASSERT_EQ(losses.size(), 1u);
    EXPECT_NE(losses.begin()->first.find("quad-buffer"), std::string::npos);
    EXPECT_FALSE(losses.begin()->second.first.empty());
}

TEST_F(WindowOnX, TwoWindowsShareTextures)
{
    Window a(window_settings({64, 64}, {0, 0}), report);
    GLuint texture = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    Window b(window_settings({64, 64}, {100, 0}), report, &a);
    EXPECT_EQ(b.number(), a.number() + 1);
    EXPECT_TRUE(glIsTexture(texture));
    b.gl().make_current();
    glDeleteTextures(1, &texture);
}

TEST_F(WindowOnX, DroppedFilesAreEvents)
{
    Window window(window_settings({64, 64}, {0, 0}), report);
    GLFWdropfun const dropped = glfwSetDropCallback(window.glfw(), nullptr);
    ASSERT_NE(dropped, nullptr);
    char const* files[] = {"/a/room.glb", "/b/hall.yaml"};
    window.take_events();
    dropped(window.glfw(), 2, files);
    std::vector<InputEvent> const events = window.take_events();
    ASSERT_EQ(events.size(), 2u);
    EXPECT_EQ(events[1].kind, InputKind::drop);
    EXPECT_EQ(events[1].text, "/b/hall.yaml");
}

TEST_F(WindowOnX, PanelDrawsAndClaimsTheMouseOverIt)
{
    Window window(window_settings({320, 240}, {0, 0}), report);
    Panel panel(window);
    if (have_xdotool()) inject("mousemove 60 60");
    std::vector<InputEvent> events;
    for (int frame = 0; frame < 3; ++frame) {
        wait_for_windows(0.05);
        for (InputEvent const& e : window.take_events()) events.push_back(e);
        glClear(GL_COLOR_BUFFER_BIT);
        panel.begin();
        ImGui::SetNextWindowPos({20, 20});
        ImGui::SetNextWindowSize({150, 100});
        ImGui::Begin("Settings");
        ImGui::Text("text");
        ImGui::End();
        panel.finish();
        panel.draw();
        if (frame < 2) window.swap();
    }
    keep_picture("panel", {320, 240}, read_bytes(target_of(window)));
    unsigned char pixel[4] = {};
    glReadPixels(60, 240 - 100, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    EXPECT_GT(pixel[0] + pixel[1] + pixel[2], 0);
    if (!have_xdotool()) return;
    InputEvent click;
    click.kind = InputKind::mouse_button;
    std::vector<InputEvent> clicks{click};
    panel.claim(clicks);
    EXPECT_EQ(clicks[0].meant_for, InputFor::panel);
}

TEST(WindowWithoutServer, SaysWhatIsMissing)
{
    std::string const before = std::getenv("DISPLAY") ? std::getenv("DISPLAY") : "";
    setenv("DISPLAY", ":4711", 1);
    std::string said;
    try {
        glfw_library();
    } catch (gi::InputError const& e) {
        said = e.what();
    }
    before.empty() ? unsetenv("DISPLAY") : setenv("DISPLAY", before.c_str(), 1);
    EXPECT_NE(said.find("DISPLAY"), std::string::npos) << said;
    EXPECT_NE(said.find("no window can be opened"), std::string::npos);
}

} // namespace
} // namespace viewer::test
