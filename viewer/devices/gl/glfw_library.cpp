#include "viewer/devices/gl/glfw_library.h"

#include "gi/core/error.h"

#include <GLFW/glfw3.h>

namespace viewer {

std::shared_ptr<void const> glfw_library()
{
    static std::weak_ptr<void const> running;
    if (auto held = running.lock()) return held;
#ifdef GLFW_PLATFORM // of 3.4; windows that are placed and swap groups need X11, the only system of earlier ones
    glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
    if (!glfwInit())
        throw gi::InputError("no window can be opened", glfw_error(),
                             "start lightwell where DISPLAY names an X server (Xvfb will do)");
    static int const kAny = 0;
    std::shared_ptr<void const> held(&kAny, [](void const*) { glfwTerminate(); });
    running = held;
    return held;
}

char const* glfw_error()
{
    char const* text = nullptr;
    return glfwGetError(&text) == GLFW_NO_ERROR || !text ? "no reason given" : text;
}

} // namespace viewer
