#pragma once
// A window with OpenGL 4.5 core. All windows belong to the main thread; only drawing may move to another one
// (GlContext::release there, make_current here).

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

/// Throws InputError where there is no display server.
std::vector<MonitorInfo> monitors();

enum class QuadBuffer { no, wanted };
enum class Visibility { shown, hidden };

struct WindowSettings {
    std::string title = "lightwell";
    glm::ivec2 size_px{1280, 720};         ///< of the content; not read in full screen
    std::optional<glm::ivec2> position_px; ///< of the content on the desktop; none = where the desktop wants it
    std::string monitor;                   ///< full screen on the one of this number or name; empty = a window
    int swap_interval = 1;                 ///< refreshes of the monitor per swap; 0 = do not wait
    QuadBuffer quad_buffer = QuadBuffer::no;
    Visibility visibility = Visibility::shown;
};

class Window {
public:
    /// Its context is current when this returns. Where the driver has no quad-buffer stereo the window is made
    /// without it and the report counts that. `shares` gives its textures and buffers to this window too.
    /// Throws InputError on a monitor that is not there, a size that is not positive, and where no window opens.
    Window(WindowSettings const& settings, gi::Report& report, Window const* shares = nullptr);
    ~Window();
    Window(Window const&) = delete;
    Window& operator=(Window const&) = delete;

    GlContext const& gl() const;
    GLFWwindow* glfw() const;
    int number() const; ///< counts the windows of the process, from 0
    glm::ivec2 framebuffer_px() const;
    /// Of the content's top left corner on the desktop: what the parity of interlaced stereo counts from.
    glm::ivec2 position_px() const;
    /// Of the monitor under the middle of the window; 0 = unknown.
    int refresh_hz() const;
    bool has_quad_buffer() const;
    bool wants_close() const;
    void set_title(std::string const& title);

    /// Shows what was drawn. The context must be current to the calling thread.
    void swap();
    /// Everything since the last call, in order. Filled by poll_windows().
    std::vector<InputEvent> take_events();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Lets GLFW hand out what happened to all windows. Never waits.
void poll_windows();
/// The same, but sleeps until something happens or the time is over.
void wait_for_windows(double timeout_s);

} // namespace viewer
