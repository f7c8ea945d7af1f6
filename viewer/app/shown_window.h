#pragma once
#include "viewer/app/presenter.h"
#include "viewer/devices/gl/swap_timer.h"
#include "viewer/devices/gl/window.h"

namespace viewer {

/// A window with what it shows.
struct ShownWindow {
    Window window;
    Presenter presenter;
    SwapTimer timer;
    std::vector<Pane> panes, shown_panes; ///< now, and of what is being shown, as are the following
    glm::ivec2 shown_px{}, on_screen_px{};

    ShownWindow(WindowSettings const& settings, std::vector<WallSettings> const& walls, gi::Report& report)
        : window(settings, report), presenter(walls), timer(window, report)
    {
    }
    /// Another window's context may be current, in which the same names belong to other objects.
    ~ShownWindow() { window.gl().make_current(); }
};

} // namespace viewer
