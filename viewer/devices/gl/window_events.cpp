#include "viewer/devices/gl/window_events.h"

#include <GLFW/glfw3.h>
#include <utility>

namespace viewer {
namespace {

WindowEvents& of(GLFWwindow* window) { return *static_cast<WindowEvents*>(glfwGetWindowUserPointer(window)); }

InputAction action_of(int glfw)
{
    return glfw == GLFW_RELEASE ? InputAction::release
                                : (glfw == GLFW_REPEAT ? InputAction::repeat : InputAction::press);
}

InputEvent at(InputKind kind, double x, double y)
{
    InputEvent event;
    event.kind = kind;
    event.x = x;
    event.y = y;
    return event;
}

InputEvent with_code(InputKind kind, int code, int action, int modifiers)
{
    InputEvent event;
    event.kind = kind;
    event.code = code;
    event.action = action_of(action);
    event.modifiers = modifiers;
    return event;
}

} // namespace

void WindowEvents::listen(GLFWwindow* window, int number)
{
    number_ = number;
    glfwSetWindowUserPointer(window, this);
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scan_code, int action, int modifiers) {
        InputEvent event = with_code(InputKind::key, key, action, modifiers);
        event.scan_code = scan_code;
        of(w).add(event);
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned unicode) {
        of(w).add(with_code(InputKind::character, int(unicode), GLFW_PRESS, 0));
    });
    glfwSetCursorPosCallback(
        window, [](GLFWwindow* w, double x, double y) { of(w).add(at(InputKind::mouse_move, x, y)); });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int modifiers) {
        InputEvent event = with_code(InputKind::mouse_button, button, action, modifiers);
        glfwGetCursorPos(w, &event.x, &event.y);
        of(w).add(event);
    });
    glfwSetScrollCallback(window,
                          [](GLFWwindow* w, double x, double y) { of(w).add(at(InputKind::scroll, x, y)); });
    glfwSetFramebufferSizeCallback(
        window, [](GLFWwindow* w, int width, int height) { of(w).add(at(InputKind::resize, width, height)); });
    glfwSetWindowPosCallback(window, [](GLFWwindow* w, int x, int y) { of(w).add(at(InputKind::move, x, y)); });
    glfwSetWindowFocusCallback(
        window, [](GLFWwindow* w, int gained) { of(w).add(with_code(InputKind::focus, 0, gained, 0)); });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, char const** paths) {
        for (int i = 0; i < count; ++i) {
            InputEvent event = at(InputKind::drop, 0, 0);
            event.text = paths[i];
            of(w).add(event);
        }
    });
    glfwSetWindowCloseCallback(window, [](GLFWwindow* w) { of(w).add(at(InputKind::close, 0, 0)); });
}

std::vector<InputEvent> WindowEvents::take() { return std::exchange(events_, {}); }

void WindowEvents::add(InputEvent event)
{
    event.window = number_;
    event.time = InputEvent::Clock::now();
    events_.push_back(event);
}

} // namespace viewer
