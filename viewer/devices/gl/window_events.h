#pragma once
// Turns the GLFW callbacks of one window into a queue of InputEvents.

#include "viewer/devices/gl/input_event.h"

#include <vector>

struct GLFWwindow;

namespace viewer {

class WindowEvents {
public:
    WindowEvents() = default;
    WindowEvents(WindowEvents const&) = delete;
    WindowEvents& operator=(WindowEvents const&) = delete;

    /// Uses the window's user pointer and callbacks; must live as long as the window.
    void listen(GLFWwindow* window, int number);
    int number() const { return number_; }
    std::vector<InputEvent> take();
    /// Appends an event, after adding the window's number and the time.
    void add(InputEvent event);

private:
    int number_ = 0;
    std::vector<InputEvent> events_;
};

} // namespace viewer
