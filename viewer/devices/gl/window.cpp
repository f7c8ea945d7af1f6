#include "viewer/devices/gl/window.h"

#include "gi/core/error.h"
#include "viewer/devices/gl/glfw_library.h"
#include "viewer/devices/gl/swap_group.h"
#include "viewer/devices/gl/window_events.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace viewer {
namespace {

MonitorInfo info_of(GLFWmonitor* monitor, int number)
{
    MonitorInfo info;
    info.number = number;
    info.name = glfwGetMonitorName(monitor);
    glfwGetMonitorPos(monitor, &info.position_px.x, &info.position_px.y);
    if (GLFWvidmode const* mode = glfwGetVideoMode(monitor)) {
        info.size_px = {mode->width, mode->height};
        info.refresh_hz = mode->refreshRate;
    }
    return info;
}

GLFWmonitor* find_monitor(std::string const& wanted)
{
    int count = 0;
    GLFWmonitor** const all = glfwGetMonitors(&count);
    std::string there;
    for (int i = 0; i < count; ++i) {
        std::string const name = glfwGetMonitorName(all[i]);
        if (wanted == name || wanted == std::to_string(i)) return all[i];
        there += fmt::format("{}{} ({})", there.empty() ? "" : ", ", i, name);
    }
    throw gi::InputError("there is no monitor '" + wanted + "'",
                         "monitors here: " + (there.empty() ? "none" : there), "name one of these");
}

} // namespace

std::vector<MonitorInfo> monitors()
{
    auto const library = glfw_library();
    int count = 0;
    GLFWmonitor** const all = glfwGetMonitors(&count);
    std::vector<MonitorInfo> out;
    for (int i = 0; i < count; ++i) out.push_back(info_of(all[i], i));
    return out;
}

struct Window::State {
    std::shared_ptr<void const> library = glfw_library();
    GLFWwindow* window = nullptr;
    WindowEvents events;
    std::optional<GlContext> gl;
    QuadBuffer quad_buffer = QuadBuffer::no;

    ~State()
    {
        gl.reset();
        if (window) glfwDestroyWindow(window);
    }

    void open(WindowSettings const& settings, GLFWmonitor* monitor, GLFWwindow* shares)
    {
        glm::ivec2 const size = monitor ? info_of(monitor, 0).size_px : settings.size_px;
        glfwWindowHint(GLFW_STEREO, quad_buffer == QuadBuffer::wanted);
        window = glfwCreateWindow(size.x, size.y, settings.title.c_str(), monitor, shares);
    }
};

Window::Window(WindowSettings const& settings, gi::Report& report, Window const* shares)
    : state_(std::make_unique<State>())
{
    static int next_number = 0;
    if (settings.size_px.x <= 0 || settings.size_px.y <= 0)
        throw gi::InputError(fmt::format("a window of {} x {} pixels", settings.size_px.x, settings.size_px.y),
                             "it needs at least one", "give a positive size");
    GLFWmonitor* const monitor = settings.monitor.empty() ? nullptr : find_monitor(settings.monitor);
    glfwDefaultWindowHints();
    GlContext::context_hints();
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE); // keep the other walls visible when one loses the focus
    glfwWindowHint(GLFW_DECORATED, settings.borders);
    // Place it before showing it, so that it never appears elsewhere.
    bool const shown = settings.visibility == Visibility::shown;
    glfwWindowHint(GLFW_VISIBLE, shown && (monitor || !settings.position_px));
    if (monitor) {
        GLFWvidmode const* mode = glfwGetVideoMode(monitor);
        glfwWindowHint(GLFW_REFRESH_RATE, mode ? mode->refreshRate : GLFW_DONT_CARE);
    }

    State& s = *state_;
    s.quad_buffer = settings.quad_buffer;
    GLFWwindow* const other = shares ? shares->glfw() : nullptr;
    s.open(settings, monitor, other);
    if (!s.window && s.quad_buffer == QuadBuffer::wanted) {
        report.lose(kNoQuadBuffer, 1, glfw_error());
        s.quad_buffer = QuadBuffer::no;
        s.open(settings, monitor, other);
    }
    if (!s.window)
        throw gi::InputError("no window with OpenGL 4.5 can be opened", glfw_error(),
                             "use a driver with OpenGL 4.5 core (Mesa's llvmpipe has it)");
    if (settings.position_px && !monitor) {
        glfwSetWindowPos(s.window, settings.position_px->x, settings.position_px->y);
        if (shown) glfwShowWindow(s.window);
    }
    s.gl.emplace(GlContext::of_window(s.window, report));
    glfwSwapInterval(settings.swap_interval);
    if (settings.swap_group > 0)
        if (std::string const why = s.gl->glx().context
                                        ? join_swap_group(settings.swap_group, settings.swap_barrier)
                                        : "the window is not one of GLX";
            !why.empty())
            report.lose("windows outside their swap group, which swap by themselves", 1,
                        fmt::format("{}: {}", settings.title, why));
    s.events.listen(s.window, next_number++);
}

Window::~Window() = default;

GlContext const& Window::gl() const { return *state_->gl; }
GLFWwindow* Window::glfw() const { return state_->window; }
int Window::number() const { return state_->events.number(); }

glm::ivec2 Window::framebuffer_px() const
{
    glm::ivec2 size{};
    glfwGetFramebufferSize(state_->window, &size.x, &size.y);
    return size;
}

glm::ivec2 Window::position_px() const
{
    glm::ivec2 position{};
    glfwGetWindowPos(state_->window, &position.x, &position.y);
    return position;
}

int Window::refresh_hz() const
{
    glm::ivec2 const middle = position_px() + framebuffer_px() / 2;
    for (MonitorInfo const& m : monitors()) {
        glm::ivec2 const at = middle - m.position_px;
        if (at.x >= 0 && at.y >= 0 && at.x < m.size_px.x && at.y < m.size_px.y) return m.refresh_hz;
    }
    return 0;
}

float Window::content_scale() const
{
    float x = 1, y = 1;
    glfwGetWindowContentScale(state_->window, &x, &y);
    return y;
}

bool Window::has_quad_buffer() const { return state_->quad_buffer == QuadBuffer::wanted; }
bool Window::wants_close() const { return glfwWindowShouldClose(state_->window) != 0; }
void Window::set_title(std::string const& title) { glfwSetWindowTitle(state_->window, title.c_str()); }
void Window::swap() { glfwSwapBuffers(state_->window); }
std::vector<InputEvent> Window::take_events() { return state_->events.take(); }

void poll_windows() { glfwPollEvents(); }
void wait_for_windows(double timeout_s) { glfwWaitEventsTimeout(timeout_s); }

} // namespace viewer
