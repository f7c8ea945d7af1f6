#pragma once
#include "viewer/app/presenter.h"
#include "viewer/devices/gl/swap_timer.h"
#include "viewer/devices/gl/window.h"

namespace viewer {

/// A window and its contents.
struct ShownWindow {
    Window window;
    Presenter presenter;
    SwapTimer timer;
    std::vector<Pane> panes, shown_panes; ///< current ones; those being shown, as are the next two
    glm::ivec2 shown_px{}, on_screen_px{};

    ShownWindow(WindowSettings const& settings, std::vector<WallSettings> const& walls, gi::Report& report)
        : window(settings, report), presenter(walls), timer(window, report)
    {
    }
    /// Another window's context may be current, where the same names denote other objects.
    ~ShownWindow() { window.gl().make_current(); }
};

} // namespace viewer
