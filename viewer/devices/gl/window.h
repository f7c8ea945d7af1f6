#pragma once
// A window with OpenGL 4.5 core. All windows belong to the main thread; only drawing may move to another thread
// (GlContext::release on the old thread, make_current on the new one).

#include "viewer/devices/gl/context.h"
#include "viewer/devices/gl/input_event.h"

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

namespace viewer {

struct MonitorInfo {
    int number = 0;           ///< GLFW's order: 0 is the primary one
    std::string name;         ///< "DP-1"
    glm::ivec2 position_px{}; ///< of its top left corner on the desktop
    glm::ivec2 size_px{};
    int refresh_hz = 0; ///< 0 = unknown
};

/// Lists the monitors. Throws InputError without a display server.
std::vector<MonitorInfo> monitors();

enum class QuadBuffer { no, wanted };
/// Name in the report if the driver has no quad-buffer stereo.
inline constexpr char const* kNoQuadBuffer = "windows without the requested quad-buffer stereo";
enum class Visibility { shown, hidden };

struct WindowSettings {
    std::string title = "lightwell";
    glm::ivec2 size_px{1280, 720};         ///< of the content; not used in full screen
    std::optional<glm::ivec2> position_px; ///< of the content on the desktop; none = chosen by the desktop
    std::string monitor;                   ///< number or name of the monitor for full screen; empty = windowed
    int swap_interval = 1;                 ///< refreshes of the monitor per swap; 0 = do not wait
    QuadBuffer quad_buffer = QuadBuffer::no;
    Visibility visibility = Visibility::shown;
    bool borders = true;  ///< the window system's frame and title
    int swap_group = 0;   ///< of the driver, whose windows swap together; 0 = none
    int swap_barrier = 0; ///< joins the groups of several machines; 0 = none
};

class Window {
public:
    /// Opens the window and makes its context current. If the driver has no quad-buffer stereo or no swap groups,
    /// the window is opened without them and this is counted in the report. The textures and buffers of `shares`
    /// are shared with this window. Throws InputError on an unknown monitor, a size that is not positive, or if no
    /// window can be opened.
    Window(WindowSettings const& settings, gi::Report& report, Window const* shares = nullptr);
    ~Window();
    Window(Window const&) = delete;
    Window& operator=(Window const&) = delete;

    GlContext const& gl() const;
    GLFWwindow* glfw() const;
    int number() const; ///< counts the windows of the process, from 0
    glm::ivec2 framebuffer_px() const;
    /// Position of the content's top left corner on the desktop: origin for the parity of interlaced stereo.
    glm::ivec2 position_px() const;
    /// Refresh rate of the monitor under the window's centre; 0 = unknown.
    int refresh_hz() const;
    float content_scale() const; ///< of the desktop's text on the window's monitor; 1 = usual
    bool has_quad_buffer() const;
    bool wants_close() const;
    void set_title(std::string const& title);

    /// Swaps the buffers. The context must be current to the calling thread.
    void swap();
    /// Events since the last call, in order. Filled by poll_windows().
    std::vector<InputEvent> take_events();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Lets GLFW deliver the events of all windows. Never waits.
void poll_windows();
/// The same, but sleeps until an event occurs or the time is over.
void wait_for_windows(double timeout_s);

} // namespace viewer
