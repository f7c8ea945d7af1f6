// The message that a window manager sends when its user closes a window.

#include "tests/viewer_gl/on_xvfb.h"

#define GLFW_EXPOSE_NATIVE_X11
#include <GLFW/glfw3.h>
#include <GLFW/glfw3native.h>

namespace viewer::test {
namespace {

using CloseOnX = OnXvfb;

TEST_F(CloseOnX, IsAnEventAndTheWindowStays)
{
    viewer::Window window(WindowSettings{}, report);
    poll_windows();
    window.take_events();
    EXPECT_FALSE(window.wants_close());
    Display* const display = glfwGetX11Display();
    XEvent message{};
    message.xclient.type = ClientMessage;
    message.xclient.window = glfwGetX11Window(window.glfw());
    message.xclient.message_type = XInternAtom(display, "WM_PROTOCOLS", False);
    message.xclient.format = 32;
    message.xclient.data.l[0] = long(XInternAtom(display, "WM_DELETE_WINDOW", False));
    XSendEvent(display, message.xclient.window, False, NoEventMask, &message);
    XSync(display, False);
    poll_windows();
    int closes = 0;
    for (InputEvent const& e : window.take_events()) closes += e.kind == InputKind::close;
    EXPECT_EQ(closes, 1);
    EXPECT_TRUE(window.wants_close());
    window.swap();
}

} // namespace
} // namespace viewer::test
